#include "server/lab/decided_tick.h"

#include <algorithm>
#include <cmath>

namespace fts::lab {
namespace {

using physics::BodyDef;
using physics::Scene;

constexpr double kRoundings = 64.0;
// Of the tick: where times are less certain than this, they are compared all the same.
constexpr double kMostDoubt = 0.01;

double largest_coordinate_m(const Scene& scene) {
    double extent = 0.0;
    for (const BodyDef& body : scene.bodies) {
        extent = std::max({extent, body.position_m.cwiseAbs().maxCoeff(), body.radius_m});
    }
    return extent;
}

// As a part of the tick, of balls that close by `step_m` in it.
double doubt(double epsilon, double extent_m, double step_m) {
    return std::min(kMostDoubt, kRoundings * epsilon * (1.0 + extent_m / step_m));
}

}  // namespace

DecidedTick decided_tick(const Scene& scene, double span_s, double epsilon, double max_work) {
    double fastest = 0.0;
    for (const BodyDef& body : scene.bodies) {
        fastest = std::max(fastest, body.velocity_mps.norm());
    }
    if (fastest == 0.0) return {Verdict::kDecided, exact_tick(scene, span_s, max_work)};
    const double extent_m = largest_coordinate_m(scene);
    const double beyond = doubt(epsilon, extent_m, fastest * span_s);
    auto exact = exact_tick(scene, span_s * (1.0 + beyond), max_work);
    if (!exact) return {Verdict::kTooBusy, std::nullopt};
    bool any_beyond = false;
    for (const OracleContact& contact : exact->contacts) {
        physics::Vec2d parting = contact.velocity_a_after_mps;
        if (contact.b) parting -= contact.velocity_b_after_mps;
        const double closing_m = std::abs(parting.dot(contact.normal)) * span_s;
        const double apart = std::abs(contact.time_s / span_s - 1.0);
        if (apart < doubt(epsilon, extent_m, closing_m)) {
            return {Verdict::kUndecided, std::nullopt};
        }
        any_beyond = any_beyond || contact.time_s > span_s;
    }
    if (any_beyond) {
        exact = exact_tick(scene, span_s, max_work);
        if (!exact) return {Verdict::kTooBusy, std::nullopt};
    }
    return {Verdict::kDecided, std::move(exact)};
}

}  // namespace fts::lab
