// accuracy-study: measures what is not measured yet, then writes the figures and the tables of the
// accuracy page. See scripts/accuracy-study.
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "server/lab/progress_bar.h"
#include "server/lab/svg_plot.h"
#include "tests/accuracy/cells.h"
#include "tests/accuracy/figures.h"

namespace fts::accuracy {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::string cells = "build/accuracy";
    std::string page = "docs/accuracy.md";
    std::string figures = "docs/figures";
    unsigned threads = 2;
};

std::vector<Cell> missing(const std::vector<Cell>& cells, const CellStore& store) {
    std::vector<Cell> left;
    for (const Cell& cell : cells) {
        if (!store.has(cell.key)) left.push_back(cell);
    }
    return left;
}

// False when stopped; what is finished is kept.
bool measure(const std::vector<Cell>& cells, unsigned threads, const char* what, CellStore& store) {
    lab::ProgressBar bar;
    std::mutex mutex;
    std::atomic<std::size_t> next = 0, done = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < cells.size(); i = next++) {
            if (!lab::nobody_interrupted()) return;
            {
                const std::lock_guard lock(mutex);
                bar.show(done, cells.size(), std::string(what) + ": " + cells[i].key);
            }
            const Json figures = cells[i].measure(lab::nobody_interrupted);
            if (!lab::nobody_interrupted()) return;
            store.put(cells[i].key, figures);
            ++done;
        }
    };
    {
        std::vector<std::jthread> workers;
        for (unsigned k = 0; k < threads; ++k) workers.emplace_back(work);
    }
    return lab::nobody_interrupted();
}

bool write_file(const fs::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    if (!out) std::fprintf(stderr, "accuracy-study: cannot write '%s'\n", file.c_str());
    return static_cast<bool>(out);
}

bool write_page(const Options& options, const CellStore& store) {
    std::error_code failure;
    fs::create_directories(options.figures, failure);
    for (const Figure& figure : figures_of(store)) {
        if (!write_file(fs::path(options.figures) / figure.file, lab::render_svg(figure.plot))) {
            return false;
        }
    }
    std::ifstream in(options.page, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) {
        std::fprintf(stderr, "accuracy-study: cannot read '%s'; name the page (--page)\n",
                     options.page.c_str());
        return false;
    }
    std::string error;
    const std::string page = with_tables(text.str(), tables_of(store), error);
    if (!error.empty()) {
        std::fprintf(stderr, "accuracy-study: %s: %s\n", options.page.c_str(), error.c_str());
        return false;
    }
    return write_file(options.page, page);
}

int run(const Options& options) {
    std::error_code failure;
    fs::create_directories(options.cells, failure);
    std::string error;
    CellStore store(fs::path(options.cells) / "cells.jsonl", error);
    if (!error.empty()) {
        std::fprintf(stderr, "accuracy-study: %s\n", error.c_str());
        return 1;
    }
    const StudyCells all = all_cells();
    const auto accuracy = missing(all.accuracy, store), cost = missing(all.cost, store);
    const std::size_t of = all.accuracy.size() + all.cost.size();
    std::printf("%zu of %zu cells are measured already (%s)\n", of - accuracy.size() - cost.size(),
                of, options.cells.c_str());
    if (!cost.empty()) store.put("machine", machine());
    lab::listen_for_interruption();
    const bool finished =
        measure(accuracy, options.threads, "accuracy", store) && measure(cost, 1, "cost", store);
    if (!finished) {
        const std::size_t left =
            missing(all.accuracy, store).size() + missing(all.cost, store).size();
        std::printf("stopped after %zu of %zu cells; the same command goes on from there\n",
                    of - left, of);
        return 130;
    }
    if (!write_page(options, store)) return 1;
    std::printf("wrote %s and the figures in %s\n", options.page.c_str(), options.figures.c_str());
    return 0;
}

}  // namespace
}  // namespace fts::accuracy

int main(int argc, char** argv) {
    fts::accuracy::Options options;
    CLI::App app("Measures the trade of speed for accuracy and writes the page about it");
    app.add_option("--cells", options.cells, "Folder of what is measured already")
        ->capture_default_str();
    app.add_option("--page", options.page, "The page whose tables are written")
        ->capture_default_str();
    app.add_option("--figures", options.figures, "Folder of the figures")->capture_default_str();
    app.add_option("--threads", options.threads, "For all but costs, which are measured alone")
        ->check(CLI::Range(1, 64))
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return fts::accuracy::run(options);
}
