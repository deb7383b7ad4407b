// The study is resumed where it was left, and writes only between its markers.
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/accuracy/cell_store.h"
#include "tests/accuracy/figures.h"

namespace fts::accuracy {
namespace {

using testing::HasSubstr;
using testing::Not;

class Folder {
  public:
    Folder() : path_(std::filesystem::temp_directory_path() / name()) {
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    static std::string name() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        return std::string("fts-") + test->name() + "-" + std::to_string(getpid());
    }
    std::filesystem::path path_;
};

TEST(CellStore, remembers_what_was_measured) {
    const Folder folder;
    std::string error;
    {
        CellStore store(folder.path() / "cells.jsonl", error);
        EXPECT_FALSE(store.has("one"));
        store.put("one", {{"E", 0.25}});
        store.put("none", nullptr);
    }
    const CellStore again(folder.path() / "cells.jsonl", error);
    EXPECT_EQ(error, "");
    EXPECT_TRUE(again.has("one"));
    EXPECT_TRUE(again.has("none"));
    EXPECT_EQ(again.find("one")["E"], 0.25);
    EXPECT_TRUE(again.find("two").is_null());
}

TEST(CellStore, measures_again_what_a_crash_cut_off_and_nothing_else) {
    const Folder folder;
    const auto file = folder.path() / "cells.jsonl";
    std::ofstream(file) << R"({"key":"whole","figures":{"E":1}})"
                        << "\n"
                        << R"({"key":"cut","figures":{"E")";
    std::string error;
    {
        CellStore store(file, error);
        EXPECT_TRUE(store.has("whole"));
        EXPECT_FALSE(store.has("cut"));
        store.put("cut", {{"E", 2.0}});
    }
    const CellStore again(file, error);
    EXPECT_EQ(again.size(), 2U);
    EXPECT_EQ(again.find("cut")["E"], 2.0);
}

TEST(CellStore, says_when_it_cannot_write) {
    std::string error;
    const CellStore store("/nowhere/at/all/cells.jsonl", error);
    EXPECT_THAT(error, HasSubstr("--cells"));
}

TEST(AccuracyPage, is_written_between_its_markers_only) {
    const std::string page = "Prose.\n<!-- table one -->\nold\n<!-- end one -->\nMore prose.\n";
    std::string error;
    const std::string once = with_tables(page, {{"one", "| new |\n"}}, error);
    EXPECT_EQ(error, "");
    EXPECT_EQ(once, "Prose.\n<!-- table one -->\n\n| new |\n\n<!-- end one -->\nMore prose.\n");
    EXPECT_EQ(with_tables(once, {{"one", "| new |\n"}}, error), once);
    EXPECT_EQ(with_tables(page, {{"two", ""}}, error), page);
    EXPECT_THAT(error, HasSubstr("two"));
}

TEST(AccuracyPage, is_written_with_its_figures_or_says_why_not) {
    const Folder folder;
    const PageFiles files = {folder.path() / "page.md", folder.path() / "figures"};
    const std::vector<Figure> figures = {{"one.svg", {}}};
    EXPECT_THAT(write_page(files, figures, {{"one", "| new |\n"}}), HasSubstr("--page"));
    std::ofstream(files.page) << "<!-- table one -->\n<!-- end one -->\n";
    EXPECT_THAT(write_page(files, figures, {{"two", ""}}), HasSubstr("page.md: "));
    EXPECT_EQ(write_page(files, figures, {{"one", "| new |\n"}}), "");
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "figures" / "one.svg"));
    std::string page;
    std::getline(std::ifstream(files.page), page, '\0');
    EXPECT_EQ(page, "<!-- table one -->\n\n| new |\n\n<!-- end one -->\n");
}

TEST(AccuracyPage, has_figures_even_before_anything_is_measured) {
    const Folder folder;
    std::string error;
    const CellStore store(folder.path() / "cells.jsonl", error);
    for (const Figure& figure : figures_of(store)) {
        EXPECT_THAT(lab::render_svg(figure.plot), Not(HasSubstr("nan"))) << figure.file;
    }
    EXPECT_EQ(tables_of(store).size(), 6U);
}

}  // namespace
}  // namespace fts::accuracy
