// From a scene and a tolerance to the cheapest way to advance it that meets it, and why.
//
// The tolerance is a *collision error*: how wrong velocities are after a tick in which something
// collided, against exact dynamics from the same state at its start, as a part of the speed:
//
//     E = sqrt( sum |v - v_exact|^2 / sum |v_exact|^2 )
//
// over the bodies that collide in the tick, in truth or by the solver, and over such ticks. It is
// local, so that it says something in chaotic scenes too, in which every trajectory is lost after
// some tens of collisions however exact the solver; and a grazing hit that is missed counts as
// little as it matters.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/physics/scene.h"
#include "common/physics/solver_choice.h"

namespace fts::physics {

enum class ScalarKind : std::uint8_t { kFloat, kDouble };

// "float", "double".
std::string_view to_string(ScalarKind kind);
std::optional<ScalarKind> scalar_from(std::string_view name);

// What a host calls them.
inline constexpr double kAutoTolerance = 1e-6;
inline constexpr double kFastTolerance = 0.1;
inline constexpr double kExactTolerance = 0.0;

struct Fidelity {
    double tolerance = kAutoTolerance;  // >= 0, of the collision error; 0: as exact as can be
    double tick_duration_s = 1.0 / 60.0;
    bool allow_float = true;
    // Bodies will thrust, so that no calendar of collisions outlives a tick.
    bool thrust = false;
};

// "auto", "fast", "exact", or a number above 0 and below 1.
std::optional<double> tolerance_from(std::string_view text);

struct Plan {
    SolverChoice solver;
    ScalarKind scalar = ScalarKind::kDouble;
    std::string broadphase;    // what finds the pairs, in words
    double error_bound = 0.0;  // of the collision error
    bool meets_tolerance = true;
    double cost_ns_per_body_tick = 0.0;  // estimated; only ratios mean something
    std::string reason;                  // one sentence
};

// The scene must be valid, but for overlaps. Its speeds are taken from its bodies as they are, and
// light bodies are expected to become as fast as their share of the energy allows.
Plan plan(const Scene& scene, const Fidelity& fidelity);

// "swept, double", "discrete, float, 4 substeps".
std::string describe(const Plan& plan);

}  // namespace fts::physics
