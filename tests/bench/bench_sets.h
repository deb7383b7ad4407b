// What scripts/bench measures, in sets: each is one run and one file, so that what is compared was
// measured together.
#pragma once

#include <string>
#include <vector>

#include "server/lab/bench/bench_cell.h"

namespace fts::bench {

struct BenchSet {
    std::string name;  // "growth"
    std::vector<lab::BenchCell> cells;
};

const std::vector<BenchSet>& bench_sets();

// The scene that density, speed and size are varied from.
inline const lab::BenchScene kCommonScene{};
inline constexpr double kSlow = 0.05, kFast = 2.0;  // radii per tick

}  // namespace fts::bench
