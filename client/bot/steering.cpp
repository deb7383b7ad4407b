#include "client/bot/steering.h"

#include <algorithm>
#include <cmath>

namespace fts::bot {
namespace {

using physics::Vec2d;

// Time in which a difference in velocity is worked off; shorter would chatter at 60 Hz.
constexpr double kResponseS = 0.12;
// Share of the full deceleration that plans count on.
constexpr double kBrakingReserve = 0.8;
// Samples along a path when looking for a hole in the way.
constexpr int kPathSamples = 8;

Vec2d unit_or(const Vec2d& v, const Vec2d& otherwise) {
    const double length = v.norm();
    return length > 1e-9 ? Vec2d(v / length) : otherwise;
}

Vec2d outward_at(const Helm& helm) {
    const Vec2d edge_m = physics::nearest_edge_point_m(helm.platform, helm.position_m);
    const bool on = physics::distance_to_edge_m(helm.platform, helm.position_m) >= 0.0;
    const Vec2d towards_edge =
        on ? Vec2d(edge_m - helm.position_m) : Vec2d(helm.position_m - edge_m);
    return unit_or(towards_edge, unit_or(helm.position_m, Vec2d::UnitX()));
}

bool path_is_clear(const Helm& helm, const Vec2d& to_m) {
    for (int i = 1; i < kPathSamples; ++i) {
        const Vec2d at_m = helm.position_m + (to_m - helm.position_m) * (double(i) / kPathSamples);
        if (physics::distance_to_edge_m(helm.platform, at_m) < kEdgeMarginM) return false;
    }
    return true;
}

// Where to head for, a step along the ring, when the straight way is barred by the hole.
Vec2d around_the_hole(const Helm& helm, const Vec2d& to_m) {
    const Vec2d here = unit_or(helm.position_m, Vec2d::UnitX());
    const double turn = here.x() * to_m.y() - here.y() * to_m.x() >= 0.0 ? 1.0 : -1.0;
    constexpr double kStepRad = 0.5;
    const double c = std::cos(kStepRad), s = turn * std::sin(kStepRad);
    return innermost_point_m(helm.platform,
                             {c * here.x() - s * here.y(), s * here.x() + c * here.y()});
}

}  // namespace

std::optional<Helm> take_helm(const Sight& sight) {
    if (sight.own == nullptr) return std::nullopt;
    const FieldBall& own = *sight.own;
    const game::BallStats stats = game::stats_for(sight.tiers);
    Helm helm;
    helm.lag_s = sight.lag_s;
    helm.position_m = own.position_m + own.velocity_mps * helm.lag_s;
    helm.velocity_mps = own.velocity_mps;
    helm.radius_m = own.radius_m;
    helm.mass_kg = own.mass_kg;
    helm.acceleration_mps2 = stats.thrust_n / stats.mass_kg;
    helm.top_speed_mps = stats.top_speed_mps;
    helm.platform = sight.field.platform;
    return helm;
}

Vec2d ahead(const Helm& helm, const FieldBall& ball, double after_s) {
    return ball.position_m + ball.velocity_mps * (helm.lag_s + after_s);
}

Vec2d innermost_point_m(const physics::Platform& platform, const Vec2d& near_m) {
    if (const auto* ring = std::get_if<physics::Ring>(&platform)) {
        return unit_or(near_m, Vec2d::UnitX()) *
               (0.5 * (ring->inner_radius_m + ring->outer_radius_m));
    }
    if (const auto* box = std::get_if<physics::Rectangle>(&platform)) {
        // The middle line of a long platform is as far from the edge as its centre.
        const double along_m = std::max(0.0, box->half_extents_m.x() - box->half_extents_m.y());
        const double across_m = std::max(0.0, box->half_extents_m.y() - box->half_extents_m.x());
        return {std::clamp(near_m.x(), -along_m, along_m),
                std::clamp(near_m.y(), -across_m, across_m)};
    }
    return Vec2d::Zero();
}

double safe_speed_mps(const Helm& helm, double distance_to_edge_m) {
    const double room_m = std::max(0.0, distance_to_edge_m - kEdgeMarginM);
    return std::sqrt(2.0 * kBrakingReserve * helm.acceleration_mps2 * room_m);
}

game::InputCommand fly_at(const Helm& helm, const Vec2d& velocity_mps) {
    const Vec2d missing_mps2 = (velocity_mps - helm.velocity_mps) / kResponseS;
    // Thrust that only holds the velocity against drag, which is a / v_top per second.
    const Vec2d holding_mps2 = velocity_mps * (helm.acceleration_mps2 / helm.top_speed_mps);
    const Vec2d wanted = (missing_mps2 + holding_mps2) / helm.acceleration_mps2;
    const double size = wanted.norm();
    return game::command_toward(size > 1.0 ? Vec2d(wanted / size) : wanted);
}

game::InputCommand fly_to(const Helm& helm, const Vec2d& point_m) {
    const Vec2d goal_m = path_is_clear(helm, point_m) ? point_m : around_the_hole(helm, point_m);
    const Vec2d way_m = goal_m - helm.position_m;
    const double distance_m = way_m.norm();
    const double stoppable_mps =
        std::sqrt(2.0 * kBrakingReserve * helm.acceleration_mps2 * distance_m);
    // Close by, the square root alone would overshoot: slow down in proportion.
    const double speed_mps =
        std::min({helm.top_speed_mps, stoppable_mps, distance_m / kResponseS * 0.5});
    return fly_at(helm, unit_or(way_m, Vec2d::Zero()) * speed_mps);
}

game::InputCommand stay_on(const Helm& helm, const game::InputCommand& wanted) {
    const double to_edge_m = physics::distance_to_edge_m(helm.platform, helm.position_m);
    const Vec2d outward = outward_at(helm);
    const double outward_mps = helm.velocity_mps.dot(outward);
    const bool too_close = to_edge_m < kEdgeMarginM;
    if (!too_close && outward_mps <= safe_speed_mps(helm, to_edge_m)) return wanted;
    const Vec2d along_mps = helm.velocity_mps - outward * outward_mps;
    const Vec2d away = -outward * helm.top_speed_mps - along_mps * 0.5;
    game::InputCommand command = fly_at(helm, away);
    command.brake = outward_mps > 0.0;
    return command;
}

}  // namespace fts::bot
