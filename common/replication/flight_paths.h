// How balls flew from one snapshot to the next, or fly on after the newest: the paths that are
// drawn. Pure functions of the snapshots and what is known of the course; called once for each pair
// of snapshots, while `FlightPaths::at` is asked every frame.
//
// The shared physics runs from the first snapshot, with the controls that are known. Paths are
// straight from knot to knot, with the kink of each hit where and when it happened. What the run
// leaves open at the second snapshot is put down to accelerations that nobody told of: the physics
// runs again with the least of them (flight_fit.h), and with hits that only they explain
// (missed_hits.h). What is open then is closed by a cubic on top of the knots, which leaves every
// kink as sharp as it is. A ball whose hits take more to explain than flight without any flew
// without.
//
// So a path begins and ends exactly where the snapshots say; without hits it is the cubic through
// both places and velocities; and where nothing is unknown it is the server's, to rounding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/replication/control_events.h"
#include "common/replication/flight_fit.h"
#include "common/replication/flight_run.h"

namespace fts::replication {

// Between snapshots that are further apart nothing is simulated, and paths are straight.
inline constexpr Tick kMaxFlightTicks = 30;
// A ball that moved this much further than twice the fastest of all flies was put elsewhere.
inline constexpr double kTeleportSlackM = 1.0;

struct FlightPose {
    physics::Vec2d position_m = physics::Vec2d::Zero();
    physics::Vec2d velocity_mps = physics::Vec2d::Zero();
};

class FlightPaths {
  public:
    // At `since_s` after the first snapshot; before it as there, after the end as at the end.
    FlightPose at(std::size_t ball, double since_s) const;
    std::size_t size() const { return ways_.size(); }
    double span_s() const { return span_s_; }
    // Between the kinks nothing but thrust and cubics bends a path.
    std::span<const Knot> knots_of(std::size_t ball) const {
        return {knots_.data() + ways_[ball].first_knot, knots_.data() + ways_[ball].end_knot};
    }

  private:
    friend class PathMaker;
    struct Way {
        std::uint32_t first_knot = 0, end_knot = 0;  // at least one
        Gap gap;                                     // closed by a cubic on top of the knots
    };
    double span_s_ = 0.0;
    std::vector<Knot> knots_;
    std::vector<Way> ways_;
};

// Of the balls of `from`, in their order; both ascend by id, and to_tick is after from_tick. A ball
// that is not in `to` flies as the run has it. One that was put elsewhere stays where it was in
// `from`, and nothing hits it. `events` as in control_events.h; empty where nobody knows any. The
// course may have a platform; it must be valid, and not periodic.
FlightPaths paths_between(const Course& course, std::span<const BallState> from, Tick from_tick,
                          std::span<const BallState> to, Tick to_tick,
                          std::span<const ControlEvent> events);

// On from the newest snapshot while its controls go on acting, for at most kMaxFlightTicks.
FlightPaths paths_beyond(const Course& course, std::span<const BallState> from, Tick ticks);

}  // namespace fts::replication
