#include "common/physics/fidelity.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "common/physics/solver_event.h"

namespace fts::physics {
namespace {

constexpr std::array<std::string_view, 2> kScalarNames = {"float", "double"};

// What overlaps tell late: the line of centres of a pair that is found s after it touched is off by
// s sin(theta) / R, with s uniform below the approach of one substep. Averaged over impact
// parameters and the speeds of a gas that is 0.3 of the displacement in radii.
constexpr double kDiscreteErrorPerRadius = 0.9;
// And what they do not tell: a body that should have turned in a substep misses whom it would have
// met next. The square of the error is about the number of collisions of a body in a substep; both
// bounds leave room for the scatter of samples (docs/accuracy.md).
constexpr double kDiscreteErrorPerCollision = 3.0;
// Beyond this displacement in radii per substep pairs begin to pass through each other.
constexpr double kMaxDiscreteStepInRadii = 0.25;
// Fewer bodies that coast collide too rarely for an average to mean something.
constexpr std::size_t kCrowd = 64;
// Cells are as wide as the largest body; smaller ones crowd in them.
constexpr double kMaxDiscreteRadiusRatio = 8.0;
// Units of round-off of the largest length, over the smallest radius.
constexpr double kExactErrorInUlps = 64.0;

// Nanoseconds on the machine that the accuracy page was measured on, all positions read every tick.
struct Cost {
    double per_body_tick;  // per substep
    double per_collision;
    double of_float;  // over that of double
};
constexpr Cost kDiscreteCost = {4.6, 185.0, 0.97};
struct ExactCosts {
    Cost swept, event;
};
// At 100 and at 1,000 bodies.
constexpr ExactCosts kCostsWithCalendar = {{14.0, 490.0, 1.05}, {4.0, 600.0, 1.1}};
constexpr ExactCosts kCostsInWindows = {{15.0, 700.0, 1.05}, {4.0, 530.0, 1.05}};

struct Scale {
    std::size_t bodies = 0;
    bool is_periodic = false;
    double smallest_radius_m = 0.0, largest_radius_m = 0.0;
    double extent_m = 0.0;  // the largest coordinate
    double step_in_radii = 0.0;
    double collisions_per_body_tick = 0.0;
    double hits_per_body_tick() const {
        return 2.0 * collisions_per_body_tick;
    }  // it has two sides
};

struct Candidate {
    SolverChoice solver;
    ScalarKind scalar = ScalarKind::kDouble;
    double error = 0.0;
    double cost_ns = 0.0;
};

std::string rounded(double value) {
    char buffer[32];
    const auto end =
        std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 2).ptr;
    return std::string(buffer, end);
}

double largest_coordinate_m(const Scene& scene) {
    double extent = scene.platform ? bounding_radius_m(*scene.platform) : 0.0;
    const auto include = [&](const Vec2d& point) {
        extent = std::max(extent, point.cwiseAbs().maxCoeff());
    };
    for (const BodyDef& body : scene.bodies) include(body.position_m);
    for (const Vec2d& corner : scene.walls ? std::vector{scene.walls->min_m, scene.walls->max_m}
                               : scene.periodic
                                   ? std::vector{scene.periodic->min_m, scene.periodic->max_m}
                                   : std::vector<Vec2d>()) {
        include(corner);
    }
    return extent;
}

double area_m2(const Scene& scene) {
    if (scene.walls) return (scene.walls->max_m - scene.walls->min_m).prod();
    if (scene.periodic) return (scene.periodic->max_m - scene.periodic->min_m).prod();
    if (scene.platform) {
        const double radius = bounding_radius_m(*scene.platform);
        return std::numbers::pi * radius * radius;
    }
    const double infinity = std::numeric_limits<double>::infinity();
    Vec2d low = Vec2d::Constant(infinity), high = -low;
    for (const BodyDef& body : scene.bodies) {
        low = low.cwiseMin(body.position_m - Vec2d::Constant(body.radius_m));
        high = high.cwiseMax(body.position_m + Vec2d::Constant(body.radius_m));
    }
    return scene.bodies.empty() ? infinity : (high - low).prod();
}

// As fast as the lightest becomes when all have the same energy, or as fast as any is now if that
// is more: a crowd by its mean, a few by their fastest.
double typical_speed_mps(const Scene& scene) {
    double energy_j = 0.0, lightest_kg = std::numeric_limits<double>::infinity();
    double fastest_mps = 0.0, sum_of_squares = 0.0;
    std::size_t finite = 0;
    for (const BodyDef& body : scene.bodies) {
        const double squared = body.velocity_mps.squaredNorm();
        fastest_mps = std::max(fastest_mps, std::sqrt(squared));
        sum_of_squares += squared;
        if (std::isinf(body.mass_kg)) continue;
        energy_j += 0.5 * body.mass_kg * squared;
        lightest_kg = std::min(lightest_kg, body.mass_kg);
        ++finite;
    }
    if (finite == 0) return fastest_mps;
    const double shared_mps = std::sqrt(2.0 * energy_j / static_cast<double>(finite) / lightest_kg);
    if (scene.bodies.size() < kCrowd) return std::max(fastest_mps, shared_mps);
    return std::max(shared_mps,
                    std::sqrt(sum_of_squares / static_cast<double>(scene.bodies.size())));
}

Scale scale_of(const Scene& scene, const Fidelity& fidelity) {
    Scale scale;
    scale.bodies = scene.bodies.size();
    scale.is_periodic = scene.periodic.has_value();
    if (scene.bodies.empty()) return scale;
    const auto [smallest, largest] = std::minmax_element(
        scene.bodies.begin(), scene.bodies.end(),
        [](const BodyDef& a, const BodyDef& b) { return a.radius_m < b.radius_m; });
    scale.smallest_radius_m = smallest->radius_m;
    scale.largest_radius_m = largest->radius_m;
    scale.extent_m = largest_coordinate_m(scene);
    scale.step_in_radii =
        typical_speed_mps(scene) * fidelity.tick_duration_s / scale.smallest_radius_m;
    double covered_m2 = 0.0;
    for (const BodyDef& body : scene.bodies) {
        covered_m2 += std::numbers::pi * body.radius_m * body.radius_m;
    }
    // A dilute gas of discs collides 1.6 times its packing fraction and displacement in radii, a
    // dense one more by Enskog's factor (Henderson's).
    const double packing = std::clamp(covered_m2 / area_m2(scene), 0.0, 0.88);
    const double crowding = (1.0 - 7.0 / 16.0 * packing) / ((1.0 - packing) * (1.0 - packing));
    scale.collisions_per_body_tick = 0.8 * packing * crowding * scale.step_in_radii;
    return scale;
}

double cost_ns(const Cost& cost, const Scale& scale, std::uint32_t substeps, ScalarKind scalar) {
    const double ns =
        cost.per_body_tick * substeps + cost.per_collision * scale.collisions_per_body_tick;
    return scalar == ScalarKind::kFloat ? cost.of_float * ns : ns;
}

// Each further collision of a body within the tick multiplies what was wrong before it, by about
// the path between two collisions over the radius.
double growth_in_a_tick(const Scale& scale) {
    const double hits = scale.hits_per_body_tick();
    const double path_in_radii = hits > 0.0 ? scale.step_in_radii / hits : 0.0;
    return std::pow(2.0 + 2.0 * path_in_radii, hits);
}

double round_off(ScalarKind scalar, const Scale& scale) {
    const double epsilon = scalar == ScalarKind::kFloat
                               ? static_cast<double>(std::numeric_limits<float>::epsilon())
                               : std::numeric_limits<double>::epsilon();
    const double lengths =
        scale.bodies == 0 ? 1.0
                          : 1.0 + scale.extent_m / scale.smallest_radius_m + scale.step_in_radii;
    return kExactErrorInUlps * epsilon * lengths * growth_in_a_tick(scale);
}

bool crowd_may_be_discrete(const Scale& scale, const Fidelity& fidelity) {
    return (fidelity.thrust || scale.bodies >= kCrowd) &&
           scale.largest_radius_m <= kMaxDiscreteRadiusRatio * scale.smallest_radius_m;
}

double discrete_error(const Scale& scale, double substeps) {
    const double late = kDiscreteErrorPerRadius * scale.step_in_radii / substeps;
    const double missed = kDiscreteErrorPerCollision * scale.hits_per_body_tick() / substeps;
    return std::sqrt(late * late + missed) * growth_in_a_tick(scale);
}

// The fewest substeps that meet the tolerance, where discrete_error is a quadratic in their
// inverse; above kMaxSubsteps when none do.
double substeps_needed(const Scale& scale, const Fidelity& fidelity) {
    const double late = kDiscreteErrorPerRadius * scale.step_in_radii;
    const double missed = kDiscreteErrorPerCollision * scale.hits_per_body_tick();
    const double tolerance = fidelity.tolerance / growth_in_a_tick(scale);
    const double squared = tolerance * tolerance;
    const double for_tolerance =
        (missed + std::sqrt(missed * missed + 4.0 * squared * late * late)) / (2.0 * squared);
    const double for_contact = scale.step_in_radii / kMaxDiscreteStepInRadii;
    return std::ceil(std::max({1.0, 1.001 * for_tolerance, for_contact}));
}

std::vector<Candidate> candidates(const Scale& scale, const Fidelity& fidelity) {
    std::vector<Candidate> found;
    const bool in_windows = scale.bodies >= kFewestInWindows && !scale.is_periodic;
    const ExactCosts& costs = in_windows ? kCostsInWindows : kCostsWithCalendar;
    for (const ScalarKind scalar : {ScalarKind::kDouble, ScalarKind::kFloat}) {
        if (scalar == ScalarKind::kFloat && !fidelity.allow_float) continue;
        const double rounding = round_off(scalar, scale);
        found.push_back(
            {{SolverKind::kSwept, 1}, scalar, rounding, cost_ns(costs.swept, scale, 1, scalar)});
        if (!fidelity.thrust) {
            found.push_back({{SolverKind::kEvent, 1},
                             scalar,
                             rounding,
                             cost_ns(costs.event, scale, 1, scalar)});
        }
        const double substeps = substeps_needed(scale, fidelity);
        if (!crowd_may_be_discrete(scale, fidelity) || !(substeps <= kMaxSubsteps)) continue;
        const auto count = static_cast<std::uint32_t>(substeps);
        const double error = std::max(rounding, discrete_error(scale, substeps));
        found.push_back({{SolverKind::kDiscrete, count},
                         scalar,
                         error,
                         cost_ns(kDiscreteCost, scale, count, scalar)});
    }
    return found;
}

// The cheapest that meets the tolerance, else the most exact, and of those the cheapest.
Candidate best_of(const std::vector<Candidate>& all, double tolerance) {
    const auto better = [&](const Candidate& a, const Candidate& b) {
        const bool a_meets = a.error <= tolerance, b_meets = b.error <= tolerance;
        if (a_meets != b_meets) return a_meets;
        if (!a_meets && a.error != b.error) return a.error < b.error;
        return a.cost_ns < b.cost_ns;
    };
    return *std::min_element(all.begin(), all.end(), better);
}

std::string broadphase_of(const Candidate& choice) {
    switch (choice.solver.kind) {
        case SolverKind::kSeed:
            return "none: every pair";
        case SolverKind::kDiscrete:
            return "uniform grid, cells of the largest diameter";
        case SolverKind::kSwept:
            return "uniform grid of the boxes that bodies sweep in a tick";
        case SolverKind::kEvent:
            return "cells of the largest diameter, crossings are events";
    }
    return {};
}

std::string why_this_kind(const Candidate& choice, const Fidelity& fidelity) {
    switch (choice.solver.kind) {
        case SolverKind::kSwept:
            return fidelity.thrust ? "exact times of impact, looked for anew each tick because "
                                     "bodies thrust"
                                   : "exact times of impact, and so many collisions a tick that a "
                                     "calendar of them would not pay";
        case SolverKind::kEvent:
            return "exact times of impact, kept in a calendar because nobody thrusts between "
                   "collisions";
        case SolverKind::kDiscrete:
            return "overlaps found after " + std::to_string(choice.solver.substeps) +
                   (choice.solver.substeps == 1 ? " step" : " steps") +
                   " a tick are close enough to the contact";
        case SolverKind::kSeed:
            break;
    }
    return {};
}

std::string reason_for(const Candidate& choice, const std::vector<Candidate>& all,
                       const Scale& scale, const Fidelity& fidelity) {
    std::string reason = "Bodies move about " + rounded(scale.step_in_radii) +
                         " radii a tick: " + why_this_kind(choice, fidelity) +
                         ", which bounds the collision error by " + rounded(choice.error);
    if (choice.error > fidelity.tolerance) {
        return reason + (fidelity.tolerance > 0.0
                             ? ", the least there is, but above the tolerance of " +
                                   rounded(fidelity.tolerance) + "."
                             : ", the least there is.");
    }
    reason += " (tolerance " + rounded(fidelity.tolerance) + ")";
    const auto runner_up =
        std::min_element(all.begin(), all.end(), [&](const Candidate& a, const Candidate& b) {
            const auto rank = [&](const Candidate& c) {
                return c.error > fidelity.tolerance || c.solver.kind == choice.solver.kind
                           ? std::numeric_limits<double>::infinity()
                           : c.cost_ns;
            };
            return rank(a) < rank(b);
        });
    if (runner_up->solver.kind != choice.solver.kind && runner_up->error <= fidelity.tolerance) {
        const double ratio = runner_up->cost_ns / choice.cost_ns;
        const std::string name(to_string(runner_up->solver.kind));
        reason += ratio < 1.2 ? "; " + name + " would take about as long"
                              : "; " + name + " would take " + rounded(ratio) + " times as long";
    }
    return reason + ".";
}

}  // namespace

std::string_view to_string(ScalarKind kind) {
    return kScalarNames[static_cast<std::size_t>(kind)];
}

std::optional<ScalarKind> scalar_from(std::string_view name) {
    if (name == kScalarNames[0]) return ScalarKind::kFloat;
    if (name == kScalarNames[1]) return ScalarKind::kDouble;
    return std::nullopt;
}

std::optional<double> tolerance_from(std::string_view text) {
    if (text == "auto") return kAutoTolerance;
    if (text == "fast") return kFastTolerance;
    if (text == "exact") return kExactTolerance;
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    if (!whole || !(value > 0.0) || !(value < 1.0)) return std::nullopt;
    return value;
}

Plan plan(const Scene& scene, const Fidelity& fidelity) {
    const Scale scale = scale_of(scene, fidelity);
    const std::vector<Candidate> all = candidates(scale, fidelity);
    const Candidate choice = best_of(all, fidelity.tolerance);
    return {choice.solver,
            choice.scalar,
            broadphase_of(choice),
            choice.error,
            fidelity.tolerance == 0.0 || choice.error <= fidelity.tolerance,
            choice.cost_ns,
            reason_for(choice, all, scale, fidelity)};
}

std::string describe(const Plan& plan) {
    std::string text =
        std::string(to_string(plan.solver.kind)) + ", " + std::string(to_string(plan.scalar));
    if (plan.solver.substeps > 1) {
        text += ", " + std::to_string(plan.solver.substeps) + " substeps";
    }
    return text;
}

}  // namespace fts::physics
