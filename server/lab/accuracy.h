// How far one solver is from exact dynamics in one scene: a vector, since no single number says it.
//
// Local figures compare single ticks: the oracle starts from the solver's own state at the start of
// the tick, as the solver holds it in its own numbers. They say something in chaotic scenes too.
// Global figures follow the whole run.
//
// Exact dynamics is known for elastic balls in a box, a periodic box or the open. A scene with a
// platform or restitution below 1 has no local figures and no divergence; what else does not apply
// is empty as well, and `remarks` say why.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/physics/scene.h"
#include "server/lab/divergence.h"
#include "server/lab/setting.h"

namespace fts::lab {

// Asked between ticks; false ends the work.
using KeepGoing = std::function<bool()>;

struct Run {
    std::size_t ticks = 600;
    double tick_s = 1.0 / 60.0;
    double seconds() const { return static_cast<double>(ticks) * tick_s; }
};

// What bounds the time that the oracle takes; reached limits are told in the figures' counts.
struct SamplingLimits {
    std::size_t collisions = 400;    // the exact ones of the ticks compared, about
    double work_of_a_tick = 2e6;     // pairs looked at (exact_tick.h)
    double work = 2e7;               // of all ticks
    double work_of_reference = 3e6;  // of the trajectory that divergence is measured from
};

struct LocalAccuracy {
    std::size_t ticks = 0;           // compared, in which something collided
    std::size_t ticks_too_busy = 0;  // left out: beyond work_of_a_tick
    // Left out: a collision so near the end of the tick that round-off decides in which tick it is.
    std::size_t ticks_undecided = 0;
    std::size_t collisions = 0;  // exact ones, of balls and with walls
    std::size_t matched = 0, missed = 0, extra = 0;
    // As in common/physics/fidelity.h; and what it would be if every collision were ignored.
    std::optional<double> collision_error, error_of_ignoring;
    std::optional<double> time_error_ticks;  // root of the mean square, of the matched
    std::optional<double> angle_error_deg;   // of the relative velocity after, likewise

    std::optional<double> missed_per_1000() const;
    std::optional<double> extra_per_1000() const;
};

struct GlobalAccuracy {
    std::size_t ticks = 0;
    std::size_t ball_collisions = 0, wall_collisions = 0;
    // Relative to what drag leaves; of momentum over the sum of |p|, what walls and infinite masses
    // gave accounted for. Signed.
    std::optional<double> energy_error;
    std::optional<double> momentum_error;
    double penetration_over_r = 0.0;  // the deepest of the run's collisions
    std::optional<Divergence> divergence;
    std::size_t overruns = 0;
    bool finite = true;  // false: something became infinite or not a number
    std::string state_hash;
};

struct Accuracy {
    LocalAccuracy local;
    GlobalAccuracy global;
    std::vector<std::string> remarks;
};

// Why the oracle cannot judge the scene; empty when it can.
std::string reason_not_to_judge(const physics::Scene& scene);

// The true trajectory, or its beginning; the same for all solvers.
struct Reference {
    std::vector<Hit> hits;
    double until_s = 0.0;  // known so far
};
// Empty when stopped, or when the oracle cannot judge the scene.
std::optional<Reference> reference_of(const physics::Scene& scene, const Run& run,
                                      const SamplingLimits& limits, const KeepGoing& keep_going);

// Empty when stopped. `reference` may be null.
std::optional<Accuracy> measure_accuracy(const physics::Scene& scene, const Setting& setting,
                                         const Run& run, const SamplingLimits& limits,
                                         const Reference* reference, const KeepGoing& keep_going);

}  // namespace fts::lab
