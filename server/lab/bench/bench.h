// Measures cells of the benchmark and tells about them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/lab/accuracy.h"
#include "server/lab/bench/bench_cell.h"
#include "server/lab/bench/specimen.h"
#include "server/lab/svg_plot.h"

namespace fts::lab {

struct BenchResult {
    BenchCell cell;
    std::string not_run;                     // why; empty when measured
    double ns_per_ball_tick = 0.0;           // of CPU time
    std::optional<double> collisions_per_s;  // of CPU time; of ours only
    Laws laws;
};

struct BenchLimits {
    unsigned repeats = 3;              // of which the median counts
    double seconds_of_a_repeat = 0.1;  // of CPU time
};

// In the cells' order; what is not finished when `keep_going` says no is left out.
std::vector<BenchResult> measure_cells(
    const std::vector<BenchCell>& cells, const BenchLimits& limits, const KeepGoing& keep_going,
    const std::function<void(std::size_t done, const BenchCell& next)>& progress);

// How many times as long the faster Chipmunk takes in the same scene. Empty without it.
std::optional<double> times_faster_than_chipmunk(const std::vector<BenchResult>& results,
                                                 const BenchResult& result);
// The result of an engine in a scene; null when it was not measured.
const BenchResult* find_result(const std::vector<BenchResult>& results, const std::string& engine,
                               const BenchScene& scene);

// A relative error, with one digit after the point; "not finite" from kEnergyLost on.
std::string energy_text(double error);

// For people: a table for each scene, with a key beneath.
std::string table_of(const std::vector<BenchResult>& results);
// For programs. What does not apply is null.
std::string json_of(const std::vector<BenchResult>& results);

// Over what a chart goes, while the rest of the scene stays.
enum class BenchAxis : std::uint8_t { kBalls, kPacking, kSpeed };

// A line for each engine, of those results whose scene is `fixed` but for the axis. Without title,
// subtitle and footnote.
Plot cost_plot(const std::vector<BenchResult>& results, BenchAxis axis, const BenchScene& fixed);

}  // namespace fts::lab
