// Where every ball is at one moment, from the two snapshots around it. A pure function.
//
// Positions and velocities go in a straight line from one snapshot to the other, which is exact
// while nothing accelerates. A ball that is only in `from` coasts on until `to` is reached and is
// gone then; one that is only in `to` is there from then on. A ball that moved further than it can
// have flown was put elsewhere, and is not drawn on the way.
#pragma once

#include <vector>

#include "common/replication/snapshot.h"

namespace fts::client {

// How far beyond the newest snapshot balls coast; after that they stand still until one arrives.
inline constexpr double kMaxExtrapolationS = 0.1;
// A ball that moved this much further than its speed explains has teleported.
inline constexpr double kTeleportSlackM = 1.0;

struct BallPose {
    const replication::BallState* state = nullptr;  // of the snapshot last reached; not owned
    physics::Vec2d position_m = physics::Vec2d::Zero();
    physics::Vec2d velocity_mps = physics::Vec2d::Zero();
};

// The balls at `draw_tick` (a tick with its fraction), sorted by id. Expects from.tick <= to.tick;
// both may be the same snapshot. Before `from`: the balls as in `from`. After `to`: coasting, at
// most kMaxExtrapolationS. The poses point into the snapshots.
std::vector<BallPose> interpolate(const replication::Snapshot& from,
                                  const replication::Snapshot& to, double draw_tick,
                                  int tick_rate_hz);

}  // namespace fts::client
