// The shared physics run on from one snapshot, with everything written down that a path is made of:
// where each ball was at every tick and every hit, and what each hit did.
//
// Not the path that is drawn (flight_paths.h): a run knows nothing of the snapshot it leads to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/replication/control_events.h"
#include "common/replication/lattice_world.h"

namespace fts::replication {

// Balls fly straight from one knot of their path to the next.
struct Knot {
    double time_s = 0.0;  // since the start of the run
    physics::Vec2d position_m = physics::Vec2d::Zero();
};

// What it takes to tell how a hit passes small changes on (flight_fit.h). For a wall `b` is the
// index after the last ball, and what is said of it is 0.
struct RunHit {
    double time_s = 0.0;
    std::uint32_t a = 0, b = 0;
    physics::Vec2d normal = physics::Vec2d::Zero();        // unit, from b towards a
    physics::Vec2d approach_mps = physics::Vec2d::Zero();  // velocity of a less that of b, before
    double impulse_ns = 0.0;
    double inverse_mass_a = 0.0, inverse_mass_b = 0.0;
    double inverse_reach = 0.0;  // 1 / (sum of the radii)
};

struct RunBall {
    double radius_m = 0.0, mass_kg = 0.0;
    physics::Vec2d end_m = physics::Vec2d::Zero(), end_mps = physics::Vec2d::Zero();
    bool fell = false;
};

// What else accelerates balls, tick by tick: of `count` balls in the first tick, then in the next.
struct Pushes {
    std::size_t count = 0;
    std::vector<physics::Vec2d> mps2;  // empty: none

    physics::Vec2d& at(Tick tick, std::size_t ball) { return mps2[tick * count + ball]; }
    const physics::Vec2d& at(Tick tick, std::size_t ball) const {
        return mps2[tick * count + ball];
    }
};

struct FlightRun {
    std::vector<Knot> knots;                // ball after ball, each in time order
    std::vector<std::uint32_t> first_knot;  // one more than there are balls
    std::vector<RunBall> balls;
    std::vector<RunHit> hits;  // in time order; those of several at one instant are left out

    std::span<const Knot> knots_of(std::size_t ball) const {
        return {knots.data() + first_knot[ball], knots.data() + first_knot[ball + 1]};
    }
};

// `events` as in control_events.h, of ticks from `from` on; `pushes` is empty or holds `ticks`
// ticks. On a platform a ball that falls flies straight on and touches nothing. Not for periodic
// scenes.
FlightRun run_flight(const Course& course, std::span<const BallState> balls, Tick from, Tick ticks,
                     std::span<const ControlEvent> events, const Pushes& pushes);

}  // namespace fts::replication
