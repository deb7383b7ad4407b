#include "tests/bench/bench_sets.h"

#include "server/lab/bench/engine.h"

namespace fts::bench {
namespace {

using lab::BenchCell;
using lab::BenchMatrix;
using lab::Radii;

std::vector<std::string> all_engines(bool with_floor) {
    std::vector<std::string> names;
    for (const lab::EngineInfo& engine : lab::engines()) {
        if (engine.is_only_by_name) continue;
        if (with_floor || !engine.is_floor) names.push_back(engine.name);
    }
    return names;
}

// Sizes, densities or speeds of one engine after the other: neighbours on a line are measured one
// after the other.
void add_by_engine(BenchMatrix matrix, const std::vector<std::string>& engines,
                   std::vector<BenchCell>& cells) {
    for (const std::string& engine : engines) {
        matrix.engines = {engine};
        const auto more = lab::cells_of(matrix);
        cells.insert(cells.end(), more.begin(), more.end());
    }
}

// What the targets speak of.
std::vector<BenchCell> target_cells() {
    const auto engines = std::vector<std::string>{
        "discrete-float", "discrete-double", "swept-float",   "swept-double", "event-float",
        "event-double",   "box2d",           "chipmunk-hash", "chipmunk-tree"};
    auto cells = lab::cells_of({engines, {10'000}, {0.3}, {Radii::kEqual}, {kSlow, kFast}});
    for (const char* const engine : {"event-double", "event-double-unread"}) {
        cells.push_back({engine, {10'000, 0.1, Radii::kEqual, kSlow}});
        cells.push_back({engine, {100'000, 0.3, Radii::kEqual, kSlow}});
    }
    cells.push_back({"event-double-unread", {10'000, 0.3, Radii::kEqual, kSlow}});
    cells.push_back({"discrete-double", {1'000'000, 0.3, Radii::kEqual, kSlow}});
    return cells;
}

std::vector<BenchCell> growth_cells() {
    std::vector<BenchCell> cells;
    add_by_engine({{},
                   {32, 100, 320, 1'000, 3'200, 10'000, 32'000, 100'000, 320'000, 1'000'000},
                   {0.3},
                   {Radii::kEqual},
                   {kSlow}},
                  all_engines(true), cells);
    return cells;
}

std::vector<BenchCell> density_cells() {
    std::vector<BenchCell> cells;
    add_by_engine({{},
                   {10'000},
                   {0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8},
                   {Radii::kEqual},
                   {kSlow}},
                  all_engines(true), cells);
    return cells;
}

std::vector<BenchCell> speed_cells() {
    std::vector<BenchCell> cells;
    add_by_engine({{},
                   {10'000},
                   {0.3},
                   {Radii::kEqual},
                   {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0}},
                  all_engines(true), cells);
    return cells;
}

std::vector<BenchCell> matrix_cells() {
    return lab::cells_of({all_engines(false),
                          {32, 200, 2'000, 10'000, 100'000},
                          {0.1, 0.3, 0.6},
                          {Radii::kEqual, Radii::kUnequal},
                          {kSlow, kFast}});
}

}  // namespace

const std::vector<BenchSet>& bench_sets() {
    static const std::vector<BenchSet> kSets = {{"targets", target_cells()},
                                                {"growth", growth_cells()},
                                                {"density", density_cells()},
                                                {"speed", speed_cells()},
                                                {"matrix", matrix_cells()}};
    return kSets;
}

}  // namespace fts::bench
