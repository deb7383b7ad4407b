// Where every ball is at one moment, from the two snapshots around it: in straight lines, or with
// the kink of every hit where and when it happened.
//
// A ball that is only in the first flies on until the second is reached and is gone then; one that
// is only in the second is there from then on. A ball that moved further than it can have flown was
// put elsewhere, and is not drawn on the way.
#pragma once

#include <utility>
#include <vector>

#include "common/replication/flight_paths.h"
#include "common/replication/snapshot.h"

namespace fts::client {

// How far beyond the newest snapshot balls fly on; after that they stand still until one arrives.
inline constexpr double kMaxExtrapolationS = 0.1;

struct BallPose {
    const replication::BallState* state = nullptr;  // of the snapshot last reached; not owned
    physics::Vec2d position_m = physics::Vec2d::Zero();
    physics::Vec2d velocity_mps = physics::Vec2d::Zero();
};

// In straight lines, velocities too: exact while nothing accelerates, and cheap. A pure function.
//
// The balls at `draw_tick` (a tick with its fraction), sorted by id. Expects from.tick <= to.tick;
// both may be the same snapshot. Before `from`: the balls as in `from`. After `to`: flying on, at
// most kMaxExtrapolationS. The poses point into the snapshots.
std::vector<BallPose> interpolate(const replication::Snapshot& from,
                                  const replication::Snapshot& to, double draw_tick,
                                  int tick_rate_hz);

// The same along the paths that the shared physics finds (flight_paths.h), which are made once for
// each two snapshots. Not thread-safe.
class FlightInterpolation {
  public:
    // What is known of the arena besides snapshots; must be valid.
    explicit FlightInterpolation(replication::Course course) : course_(std::move(course)) {}

    // `controls`: what is known of what people did from `from` to `to`.
    std::vector<BallPose> at(const replication::Snapshot& from, const replication::Snapshot& to,
                             std::span<const replication::ControlEvent> controls, double draw_tick);

  private:
    const replication::FlightPaths& paths_beyond(const replication::Snapshot& newest);
    const replication::FlightPaths& paths_between(
        const replication::Snapshot& from, const replication::Snapshot& to,
        std::span<const replication::ControlEvent> controls);

    replication::Course course_;
    replication::FlightPaths paths_;
    // Of which two snapshots; the same one twice: beyond it.
    replication::Tick from_tick_ = 0, to_tick_ = 0;
    bool has_paths_ = false;
};

}  // namespace fts::client
