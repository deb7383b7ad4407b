// fts-bench: every cell of every set as a Google Benchmark, called "SET/ENGINE/N:.../...". The time
// is of ticks alone. To --benchmark_out go the medians of the repetitions, with their spread, and
// why a cell was not run. See scripts/bench.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iterator>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "server/lab/bench/specimen.h"
#include "tests/accuracy/figures.h"
#include "tests/bench/bench_sets.h"

namespace fts::bench {
namespace {

void run_cell(benchmark::State& state, lab::SpecimenStore& store, const lab::BenchCell& cell) {
    using benchmark::Counter;
    std::string not_run;
    lab::Specimen* const specimen = store.get(cell, not_run);
    if (specimen == nullptr) return state.SkipWithError(not_run.c_str());
    lab::Engine& engine = specimen->engine();
    const auto before = engine.collisions();
    for ([[maybe_unused]] const auto tick : state) engine.step();
    state.counters["ns_per_ball_tick"] =
        Counter(1e-9 * static_cast<double>(cell.scene.balls),
                Counter::kIsIterationInvariantRate | Counter::kInvert);
    if (before) {
        state.counters["collisions_per_s"] =
            Counter(static_cast<double>(*engine.collisions() - *before), Counter::kIsRate);
    }
    const lab::Laws& laws = specimen->laws();
    state.counters["energy_error"] = laws.energy_error;
    state.counters["energy_error_after_ticks"] = static_cast<double>(laws.ticks);
    if (laws.head_on) {
        state.counters["head_on_pairs"] = static_cast<double>(laws.head_on->pairs);
        state.counters["head_on_through"] = static_cast<double>(laws.head_on->through);
    }
}

// What is kept: medians, the coefficients of variation, and once what went wrong.
template <typename Reporter>
class MedianReporter : public Reporter {
  public:
    void ReportRuns(const std::vector<benchmark::BenchmarkReporter::Run>& runs) override {
        std::vector<benchmark::BenchmarkReporter::Run> kept;
        std::ranges::copy_if(runs, std::back_inserter(kept), [](const auto& run) {
            return run.aggregate_name == "median" || run.aggregate_name == "cv" ||
                   (run.error_occurred && run.repetition_index <= 0);
        });
        if (!kept.empty()) Reporter::ReportRuns(kept);
    }
};

void register_all(lab::SpecimenStore& store) {
    for (const BenchSet& set : bench_sets()) {
        for (const lab::BenchCell& cell : set.cells) {
            if (!lab::reason_not_to_run(cell).empty()) continue;
            const std::string name = set.name + "/" + lab::name_of(cell);
            benchmark::RegisterBenchmark(name.c_str(), [&store, &cell](benchmark::State& state) {
                run_cell(state, store, cell);
            });
        }
    }
}

bool wants_file(int argc, char** argv) {
    return std::any_of(argv, argv + argc, [](const std::string& argument) {
        return argument.starts_with("--benchmark_out=");
    });
}

int run_all(int argc, char** argv) {
    const bool to_file = wants_file(argc, argv);
    lab::SpecimenStore store;
    register_all(store);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::AddCustomContext("machine", accuracy::machine());
    if (to_file) {
        MedianReporter<benchmark::JSONReporter> file;
        benchmark::RunSpecifiedBenchmarks(nullptr, &file);
    } else {
        benchmark::RunSpecifiedBenchmarks();
    }
    return 0;
}

}  // namespace
}  // namespace fts::bench

int main(int argc, char** argv) {
    try {
        return fts::bench::run_all(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fts-bench: %s\n", error.what());
        return 1;
    }
}
