// Advances a scene by some time with one solver, as fast as it goes, and measures what it did to
// what is conserved and what it cost. Only World::step is on the clock.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "common/physics/scene.h"
#include "common/physics/world.h"
#include "server/lab/setting.h"

namespace fts::lab {

struct RunSettings {
    Setting setting;
    double rate_hz = 60.0;  // ticks per second, > 0
    double seconds = 0.0;   // >= 0; where it is no whole number of ticks, the last one is shorter
};

struct RunResult {
    std::uint64_t ticks = 0;
    double simulated_s = 0.0;
    std::size_t bodies_at_start = 0, bodies_at_end = 0;
    std::uint64_t falls = 0;
    physics::CollisionAudit audit;
    double energy_at_start_j = 0.0, energy_at_end_j = 0.0;
    physics::Vec2d momentum_at_start_ns = physics::Vec2d::Zero();
    physics::Vec2d momentum_at_end_ns = physics::Vec2d::Zero();
    double momentum_scale_ns = 0.0;  // sum of |p| at the start
    // Of discs in each other or beyond a wall, in units of the smaller radius: when hits were found
    // and after each tick.
    double deepest_overlap = 0.0;
    std::uint64_t overruns = 0;  // how often a tick had to be taken up again
    std::uint64_t state_hash = 0;
    double body_ticks = 0.0;  // sum of bodies over all ticks
    double stepping_s = 0.0;
    bool was_stopped = false;
    // Not empty: why the run ended before its time; what had been simulated until then is above.
    std::string stuck;

    double energy_error() const;    // relative; 0 where there was no energy
    double momentum_error() const;  // over the sum of |p|
    double ns_per_body_tick() const;
    double collisions_per_s() const;  // of the machine's time
};

// Where a run has got to. `tick` counts from 0, at which nothing has moved.
struct RunState {
    std::uint64_t tick = 0;
    std::uint64_t ticks_in_all = 0;
    double time_s = 0.0;
    std::uint64_t collisions = 0;
};

struct Observer {
    // Asked after each tick; false ends the run.
    std::function<bool(const RunState&)> go_on = nullptr;
    // Whether to show the bodies of this tick, and where to. Not on the clock.
    std::function<bool(const RunState&)> wants_bodies = nullptr;
    std::function<void(const RunState&, std::uint32_t body, const physics::Vec2d& position_m,
                       const physics::Vec2d& velocity_mps)>
        show = nullptr;
};

// The scene must be valid but for overlaps.
RunResult run(const physics::Scene& scene, const RunSettings& settings, const Observer& observer);

}  // namespace fts::lab
