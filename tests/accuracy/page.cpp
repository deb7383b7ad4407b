#include "tests/accuracy/page.h"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

namespace fts::accuracy {
namespace {

namespace fs = std::filesystem;

std::string write_file(const fs::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    return out ? "" : "cannot write '" + file.string() + "'";
}

}  // namespace

std::string with_tables(std::string page, const std::vector<Table>& tables, std::string& error) {
    for (const Table& table : tables) {
        const std::string begin = "<!-- table " + table.name + " -->\n";
        const std::string end = "<!-- end " + table.name + " -->";
        const std::size_t from = page.find(begin);
        const std::size_t to = from == std::string::npos ? from : page.find(end, from);
        if (to == std::string::npos) {
            error = "the page has no '<!-- table " + table.name + " -->' and '" + end + "'";
            return page;
        }
        page.replace(from + begin.size(), to - from - begin.size(), "\n" + table.markdown + "\n");
    }
    return page;
}

std::string write_page(const PageFiles& files, const std::vector<Figure>& figures,
                       const std::vector<Table>& tables) {
    std::error_code failure;
    fs::create_directories(files.figures, failure);
    for (const Figure& figure : figures) {
        const std::string error =
            write_file(fs::path(files.figures) / figure.file, lab::render_svg(figure.plot));
        if (!error.empty()) return error;
    }
    std::ifstream in(files.page, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) return "cannot read '" + files.page + "'; name the page (--page)";
    std::string error;
    const std::string page = with_tables(text.str(), tables, error);
    if (!error.empty()) return files.page + ": " + error;
    return write_file(files.page, page);
}

}  // namespace fts::accuracy
