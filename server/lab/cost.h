// What a solver costs on this machine: time of World::step alone.
#pragma once

#include <cstddef>
#include <optional>

#include "common/physics/scene.h"
#include "server/lab/accuracy.h"
#include "server/lab/setting.h"

namespace fts::lab {

struct CostLimits {
    unsigned repeats = 3;
    double seconds_of_a_repeat = 0.06;
};

struct Cost {
    double ns_per_body_tick = 0.0;         // the median of the repeats
    double collisions_per_s = 0.0;         // of balls and with walls, per second of computing
    double least_ns = 0.0, most_ns = 0.0;  // per body and tick, of the repeats
    std::size_t ticks = 0;                 // of a repeat, from the start of the scene
    unsigned repeats = 0;
};

// Each repeat begins with a new world and times its ticks after the first, as many of the run as
// fit. Empty when stopped, or when there is nothing to time.
std::optional<Cost> measure_cost(const physics::Scene& scene, const Setting& setting,
                                 const Run& run, const CostLimits& limits,
                                 const KeepGoing& keep_going);

}  // namespace fts::lab
