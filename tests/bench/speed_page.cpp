// speed-page: writes the figures and tables of the speed page from what fts-bench left. See
// scripts/bench.
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "tests/accuracy/page.h"
#include "tests/bench/speed_tables.h"

namespace fts::bench {
namespace {

struct PageOptions {
    std::string results = "docs/bench";
    accuracy::PageFiles to = {"docs/speed.md", "docs/figures"};
};

int complain_about(const std::string& what) {
    std::fprintf(stderr, "speed-page: %s\n", what.c_str());
    return 1;
}

int write_speed_page(const PageOptions& options) {
    std::string error;
    const auto sets = read_sets(options.results, error);
    if (!error.empty()) return complain_about(error);
    error = accuracy::write_page(options.to, speed_figures(sets), speed_tables(sets));
    if (!error.empty()) return complain_about(error);
    std::printf("wrote %s and the figures in %s\n", options.to.page.c_str(),
                options.to.figures.c_str());
    return 0;
}

}  // namespace
}  // namespace fts::bench

int main(int argc, char** argv) {
    fts::bench::PageOptions options;
    CLI::App app("Writes the figures and tables of the speed page");
    app.add_option("--results", options.results, "Folder of what fts-bench left")
        ->capture_default_str();
    app.add_option("--page", options.to.page, "The page whose tables are written")
        ->capture_default_str();
    app.add_option("--figures", options.to.figures, "Folder of the figures")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return fts::bench::write_speed_page(options);
}
