// One tick of exact dynamics from a given state, fast enough to be asked of a thousand balls.
//
// Bodies that cannot meet in this tick are nothing to each other, so the oracle is asked about
// groups that can. The groups are found from straight paths, then from the paths that the oracle
// gives; where those of two groups come near each other the groups are joined and asked again. What
// is left is exact: no two paths of different groups touch.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/physics/scene.h"
#include "server/lab/oracle.h"

namespace fts::lab {

struct ExactTick {
    std::vector<physics::Vec2d> velocity_after_mps;  // by body, as numbered in the scene
    std::vector<OracleContact> contacts;             // in time order, likewise
    // Pairs that the oracle looked at: all at the start, and those of both partners at each event.
    double work = 0.0;
};

// Empty when more than `max_work` would be needed. The scene must be one that the oracle takes.
std::optional<ExactTick> exact_tick(const physics::Scene& scene, double span_s, double max_work);

}  // namespace fts::lab
