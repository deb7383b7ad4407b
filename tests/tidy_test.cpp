// The house keeps its own rules (tests/tidy/rules.h), and the scanner that says so catches what it
// should.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/tidy/scan.h"

namespace fts::tidy {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

bool is_source(const std::string& path) {
    return path.ends_with(".cpp") || path.ends_with(".h");
}

bool is_text(const fs::path& path) {
    static const std::set<std::string> kExtensions{".cpp",   ".h",    ".md",   ".txt", ".cmake",
                                                   ".proto", ".json", ".yaml", ".yml", ".level",
                                                   ".scene", ".js",   ".html"};
    const std::string name = path.filename().string();
    return kExtensions.contains(path.extension().string()) ||
           (path.extension().empty() && name != "LICENSE") || name == ".clang-tidy";
}

// Paths from the root of everything that people wrote, sorted.
std::vector<std::string> files_of_the_house() {
    const fs::path root = FTS_SOURCE_ROOT;
    std::vector<std::string> files;
    for (auto it = fs::recursive_directory_iterator(root); it != fs::recursive_directory_iterator();
         ++it) {
        const std::string name = it->path().filename().string();
        const bool elsewhere = name == ".git" || name == ".cache" || name == "corpus" ||
                               name == "regressions" ||
                               (it.depth() == 0 && name.starts_with("build"));
        if (it->is_directory() && elsewhere) {
            it.disable_recursion_pending();
        } else if (it->is_regular_file() && is_text(it->path())) {
            files.push_back(fs::relative(it->path(), root).string());
        }
    }
    std::ranges::sort(files);
    return files;
}

std::string text_of(const std::string& path) {
    return content_of(fs::path(FTS_SOURCE_ROOT) / path);
}

void report(const std::vector<Breach>& breaches) {
    for (const Breach& breach : breaches) {
        ADD_FAILURE() << breach.path << ":" << breach.line << ": " << breach.what;
    }
}

std::vector<Breach> planted(const std::string& path, const std::string& text) {
    return breaches_of_source(path, text);
}

std::string lines(std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
        text += "int x;\n";
    }
    return text;
}

TEST(House, has_files_to_look_at) {
    EXPECT_GT(files_of_the_house().size(), 30U);
}

TEST(House, keeps_rooms_third_parties_sizes_and_headers_in_order) {
    for (const std::string& path : files_of_the_house()) {
        if (is_source(path)) {
            report(breaches_of_source(path, text_of(path)));
        }
    }
}

TEST(House, speaks_of_itself_alone_and_leaves_nothing_unfinished) {
    for (const std::string& path : files_of_the_house()) {
        report(breaches_of_text(path, text_of(path)));
    }
}

TEST(House, names_its_files_by_what_is_in_them) {
    for (const std::string& path : files_of_the_house()) {
        report(breaches_of_name(path));
    }
}

// Every word of every CMakeLists.txt, folders cut off: the names of the files that are built.
std::set<std::string> names_in_build_lists() {
    std::set<std::string> names;
    for (const std::string& path : files_of_the_house()) {
        if (path.ends_with("CMakeLists.txt")) {
            std::string text = text_of(path);
            std::ranges::replace_if(
                text, [](char c) { return c == '/' || c == '(' || c == ')'; }, ' ');
            std::istringstream words(text);
            names.insert(std::istream_iterator<std::string>(words), {});
        }
    }
    return names;
}

TEST(House, builds_every_source_it_has) {
    const auto built = names_in_build_lists();
    for (const std::string& path : files_of_the_house()) {
        if (path.ends_with(".cpp")) {
            EXPECT_TRUE(built.contains(fs::path(path).filename().string()))
                << path << ":1: no CMakeLists.txt names it; add it to its room's, or remove it";
        }
    }
}

TEST(Scanner, sees_a_room_that_reaches_into_another) {
    EXPECT_EQ(planted("common/net/a.cpp", "#include \"common/replication/wire.h\"\n").size(), 1U);
    EXPECT_EQ(planted("common/replication/a.cpp", "#include \"common/net/transport.h\"\n").size(),
              1U);
    EXPECT_EQ(planted("common/physics/a.cpp", "#include \"common/game/rules.h\"\n").size(), 1U);
    EXPECT_EQ(planted("server/a.cpp", "#include \"client/core/view.h\"\n").size(), 1U);
    EXPECT_EQ(planted("client/core/a.cpp", "#include \"server/match/match.h\"\n").size(), 1U);
    EXPECT_EQ(planted("client/bot/a.cpp", "#include \"common/replication/wire.h\"\n").size(), 1U);
    EXPECT_EQ(planted("server/a.cpp", "int a;\n  #  include \"client/core/view.h\"\n")[0].line, 2U);
}

TEST(Scanner, lets_a_room_see_what_its_row_and_the_exceptions_name) {
    EXPECT_TRUE(planted("common/net/a.cpp", "#include \"common/net/transport.h\"\n").empty());
    EXPECT_TRUE(planted("server/match/a.cpp", "#include \"common/net/transport.h\"\n").empty());
    EXPECT_TRUE(planted("server/a.cpp", "#include \"server/match/match.h\"\n").empty());
    EXPECT_TRUE(
        planted("client/sdl/a.cpp", "#include \"common/replication/messages.h\"\n").empty());
    EXPECT_TRUE(planted("common/game/a.cpp", "// #include \"server/match/match.h\"\n").empty());
}

TEST(Scanner, sees_an_include_that_is_not_written_from_the_root) {
    EXPECT_EQ(planted("server/match/a.cpp", "#include \"match.h\"\n").size(), 1U);
    EXPECT_EQ(planted("server/match/a.cpp", "#include \"../ai/brain.h\"\n").size(), 1U);
}

TEST(Scanner, sees_a_third_party_that_left_its_home) {
    EXPECT_EQ(planted("server/a.cpp", "#include <asio.hpp>\n").size(), 1U);
    EXPECT_EQ(planted("client/core/a.cpp", "#include <sodium.h>\n").size(), 1U);
    EXPECT_EQ(planted("server/a.cpp", "#include \"arena.pb.h\"\n").size(), 1U);
    EXPECT_EQ(
        planted("server/match/match.cpp", "#include <google/protobuf/text_format.h>\n").size(), 1U);
    EXPECT_EQ(planted("client/core/a.cpp", "#include <SDL.h>\n").size(), 1U);
    EXPECT_EQ(planted("client/bot/a.cpp", "#include <imgui.h>\n").size(), 1U);
    EXPECT_EQ(planted("server/match/a.cpp", "#include <sqlite3.h>\n").size(), 1U);
    EXPECT_EQ(planted("server/match/a.cpp", "#include <boost/any.hpp>\n").size(), 1U);
    EXPECT_TRUE(planted("common/net/udp.cpp", "#include <asio.hpp>\n").empty());
    EXPECT_TRUE(planted("common/replication/wire.cpp", "#include \"arena.pb.h\"\n").empty());
}

TEST(Scanner, sees_a_third_party_that_leaks_through_a_header) {
    const std::string body = "// What it is.\n#pragma once\n#include <asio.hpp>\n";
    EXPECT_EQ(planted("common/net/udp.h", body).size(), 1U);
}

TEST(Scanner, sees_a_clock_where_the_same_calls_must_give_the_same_bits) {
    EXPECT_EQ(planted("common/physics/a.cpp", "#include <chrono>\n").size(), 1U);
    EXPECT_EQ(planted("server/match/a.cpp", "#include <unordered_map>\n").size(), 1U);
    EXPECT_TRUE(planted("server/a.cpp", "#include <chrono>\n").empty());
}

TEST(Scanner, sees_a_file_that_is_too_long_only_when_it_is) {
    EXPECT_TRUE(planted("server/a.cpp", lines(500)).empty());
    EXPECT_EQ(planted("server/a.cpp", lines(501)).size(), 1U);
}

TEST(Scanner, sees_a_function_that_is_too_long_only_when_it_is) {
    EXPECT_TRUE(planted("server/a.cpp", "void f() {\n" + lines(68) + "}\n").empty());
    const auto breaches =
        planted("server/a.cpp", "namespace a {\nvoid f() {\n" + lines(69) + "}\n}\n");
    ASSERT_EQ(breaches.size(), 1U);
    EXPECT_EQ(breaches[0].line, 2U);
    EXPECT_EQ(planted("server/a.cpp", "TEST(A, b) {\n" + lines(69) + "}\n").size(), 1U);
    EXPECT_EQ(
        planted("server/a.cpp", "template <class T>\nT f(T t) {\n" + lines(69) + "}\n").size(), 1U);
    EXPECT_EQ(
        planted("server/a.cpp", "class A {\n A() : b{1}, c(2) {\n" + lines(69) + "}\n};").size(),
        1U);
}

TEST(Scanner, does_not_take_a_namespace_a_class_or_a_table_for_a_function) {
    EXPECT_TRUE(planted("server/a.cpp", "namespace a {\n" + lines(100) + "}\n").empty());
    EXPECT_TRUE(
        planted("server/a.cpp", "template <int N>\nclass A {\n" + lines(100) + "};\n").empty());
    EXPECT_TRUE(planted("server/a.cpp", "const auto t = f({\n" + lines(100) + "});\n").empty());
    EXPECT_TRUE(planted("server/a.cpp", "int t[f(3)] = {\n" + lines(100) + "};\n").empty());
}

TEST(Scanner, is_not_led_astray_by_braces_in_comments_literals_and_macros) {
    const std::string noise =
        "// {\n/* {{ */\nconst char* s = \"{\\\"{\";\nchar c = '{';\n"
        "auto r = R\"x({{{)\" )x\";\n#define OPEN { \\\n  {\nint big = 1'000;\n";
    const auto functions = functions_of("void f() {\n" + noise + "}\nvoid g() {\n}\n");
    ASSERT_EQ(functions.size(), 2U);
    EXPECT_EQ(functions[1].lines, 2U);
}

TEST(Scanner, sees_a_header_without_guard_or_contract) {
    EXPECT_TRUE(planted("server/a.h", "// What it is.\n#pragma once\n").empty());
    EXPECT_EQ(planted("server/a.h", "#pragma once\n").size(), 2U);
    EXPECT_EQ(planted("server/a.h", "// What it is.\n").size(), 1U);
}

TEST(Scanner, sees_unfinished_work_and_foreign_paths) {
    const std::string note = std::string("// TO") + "DO: later\n";
    EXPECT_EQ(breaches_of_text("server/a.cpp", "int a;\n" + note).at(0).line, 2U);
    EXPECT_EQ(breaches_of_text("docs/a.md", std::string("see /wo") + "rk/main").size(), 1U);
    EXPECT_TRUE(
        breaches_of_text("docs/a.md", "how things work/play, and a /network/ path").empty());
}

TEST(Scanner, sees_names_that_say_nothing) {
    EXPECT_EQ(breaches_of_name("server/match_utils.cpp").size(), 1U);
    EXPECT_EQ(breaches_of_name("common/misc.h").size(), 1U);
    EXPECT_EQ(breaches_of_name("common/BallState.h").size(), 1U);
    EXPECT_TRUE(breaches_of_name("common/physics/world.h").empty());
}

}  // namespace
}  // namespace fts::tidy
