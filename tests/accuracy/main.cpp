// accuracy-study: measures what is not measured yet, then writes the figures and the tables of the
// accuracy page. See scripts/accuracy-study.
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "server/lab/progress_bar.h"
#include "tests/accuracy/cells.h"
#include "tests/accuracy/figures.h"

namespace fts::accuracy {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::string cells = "build/accuracy";
    PageFiles to = {"docs/accuracy.md", "docs/figures"};
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

int complain_about(const std::string& what) {
    std::fprintf(stderr, "accuracy-study: %s\n", what.c_str());
    return 1;
}

int run(const Options& options) {
    std::error_code failure;
    fs::create_directories(options.cells, failure);
    std::string error;
    CellStore store(fs::path(options.cells) / "cells.jsonl", error);
    if (!error.empty()) return complain_about(error);
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
    error = write_page(options.to, figures_of(store), tables_of(store));
    if (!error.empty()) return complain_about(error);
    std::printf("wrote %s and the figures in %s\n", options.to.page.c_str(),
                options.to.figures.c_str());
    return 0;
}

}  // namespace
}  // namespace fts::accuracy

int main(int argc, char** argv) {
    fts::accuracy::Options options;
    CLI::App app("Measures the trade of speed for accuracy and writes the page about it");
    app.add_option("--cells", options.cells, "Folder of what is measured already")
        ->capture_default_str();
    app.add_option("--page", options.to.page, "The page whose tables are written")
        ->capture_default_str();
    app.add_option("--figures", options.to.figures, "Folder of the figures")->capture_default_str();
    app.add_option("--threads", options.threads, "For all but costs, which are measured alone")
        ->check(CLI::Range(1, 64))
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return fts::accuracy::run(options);
}
