#include "server/lab/bench/bench.h"

#include <algorithm>
#include <ctime>

namespace fts::lab {
namespace {

double cpu_time_s() {
    std::timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct TimedTicks {
    double seconds = 0.0;
    double ticks = 0.0;
    double collisions = 0.0;
};

// Ticks for about so long. The clock is asked after batches that grow, so that it costs nothing.
TimedTicks timed_ticks(Engine& engine, double budget_s) {
    TimedTicks timed;
    const auto before = engine.collisions();
    const double start_s = cpu_time_s();
    for (std::size_t batch = 1; timed.seconds < budget_s;) {
        for (std::size_t tick = 0; tick < batch; ++tick) engine.step();
        timed.ticks += static_cast<double>(batch);
        timed.seconds = cpu_time_s() - start_s;
        if (timed.seconds < budget_s / 16.0) batch *= 2;
    }
    if (before) timed.collisions = static_cast<double>(*engine.collisions() - *before);
    return timed;
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

// False when stopped.
bool measure_cell(SpecimenStore& store, const BenchLimits& limits, const KeepGoing& keep_going,
                  BenchResult& result) {
    result.not_run = reason_not_to_run(result.cell);
    if (!result.not_run.empty()) return true;
    Specimen* const specimen = store.get(result.cell, result.not_run);
    if (specimen == nullptr) return true;
    result.laws = specimen->laws();
    const auto balls = static_cast<double>(result.cell.scene.balls);
    std::vector<double> ns, rates;
    for (unsigned k = 0; k < limits.repeats; ++k) {
        if (!keep_going()) return false;
        const TimedTicks timed = timed_ticks(specimen->engine(), limits.seconds_of_a_repeat);
        ns.push_back(1e9 * timed.seconds / (timed.ticks * balls));
        rates.push_back(timed.collisions / timed.seconds);
    }
    result.ns_per_ball_tick = median(ns);
    if (specimen->engine().collisions()) result.collisions_per_s = median(rates);
    return true;
}

}  // namespace

std::vector<BenchResult> measure_cells(
    const std::vector<BenchCell>& cells, const BenchLimits& limits, const KeepGoing& keep_going,
    const std::function<void(std::size_t done, const BenchCell& next)>& progress) {
    SpecimenStore store;
    std::vector<BenchResult> results;
    for (const BenchCell& cell : cells) {
        if (!keep_going()) break;
        progress(results.size(), cell);
        BenchResult result;
        result.cell = cell;
        if (!measure_cell(store, limits, keep_going, result)) break;
        results.push_back(std::move(result));
    }
    return results;
}

const BenchResult* find_result(const std::vector<BenchResult>& results, const std::string& engine,
                               const BenchScene& scene) {
    for (const BenchResult& result : results) {
        if (result.cell.engine == engine && result.cell.scene == scene && result.not_run.empty()) {
            return &result;
        }
    }
    return nullptr;
}

std::optional<double> times_faster_than_chipmunk(const std::vector<BenchResult>& results,
                                                 const BenchResult& result) {
    std::optional<double> theirs;
    for (const char* engine : {"chipmunk-hash", "chipmunk-tree"}) {
        const BenchResult* const peer = find_result(results, engine, result.cell.scene);
        if (peer == nullptr) continue;
        theirs = std::min(theirs.value_or(peer->ns_per_ball_tick), peer->ns_per_ball_tick);
    }
    if (!theirs || !result.not_run.empty() || !(result.ns_per_ball_tick > 0.0)) return std::nullopt;
    return *theirs / result.ns_per_ball_tick;
}

}  // namespace fts::lab
