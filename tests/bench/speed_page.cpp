// speed-page: writes the figures and tables of the speed page from what fts-bench left. See
// scripts/bench.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>

#include "server/lab/svg_plot.h"
#include "tests/bench/speed_tables.h"

namespace fts::bench {
namespace {

namespace fs = std::filesystem;

struct PageOptions {
    std::string results = "docs/bench";
    std::string page = "docs/speed.md";
    std::string figures = "docs/figures";
};

int complain_about(const std::string& what) {
    std::fprintf(stderr, "speed-page: %s\n", what.c_str());
    return 1;
}

bool write_file(const fs::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    return static_cast<bool>(out);
}

int write_speed_page(const PageOptions& options) {
    std::string error;
    const auto sets = read_sets(options.results, error);
    if (!error.empty()) return complain_about(error);
    std::error_code failure;
    fs::create_directories(options.figures, failure);
    for (const accuracy::Figure& figure : speed_figures(sets)) {
        const fs::path file = fs::path(options.figures) / figure.file;
        if (!write_file(file, lab::render_svg(figure.plot))) {
            return complain_about("cannot write '" + file.string() + "'");
        }
    }
    std::ifstream in(options.page, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) return complain_about("cannot read '" + options.page + "'; name the page (--page)");
    const std::string page = accuracy::with_tables(text.str(), speed_tables(sets), error);
    if (!error.empty()) return complain_about(options.page + ": " + error);
    if (!write_file(options.page, page))
        return complain_about("cannot write '" + options.page + "'");
    std::printf("wrote %s and the figures in %s\n", options.page.c_str(), options.figures.c_str());
    return 0;
}

}  // namespace
}  // namespace fts::bench

int main(int argc, char** argv) {
    fts::bench::PageOptions options;
    CLI::App app("Writes the figures and tables of the speed page");
    app.add_option("--results", options.results, "Folder of what fts-bench left")
        ->capture_default_str();
    app.add_option("--page", options.page, "The page whose tables are written")
        ->capture_default_str();
    app.add_option("--figures", options.figures, "Folder of the figures")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return fts::bench::write_speed_page(options);
}
