#include "server/ai/steering.h"

#include <algorithm>
#include <cmath>

namespace fts::server::ai {
namespace {

using physics::Vec2d;

constexpr double kSidewaysGain = 2.0;
constexpr double kArrivedM = 0.5;
// Room left at the edge after the stop, and the least distance to it that is not yet an emergency.
constexpr double kEdgeMarginM = 0.6;
constexpr int kWaySamples = 8;
// Who has this much room to the edge stays where it is: were all to go on inwards, a crowd would
// jam in the middle.
constexpr double kAtRestM = 8.0;

Vec2d perpendicular(const Vec2d& vector) {
    return {-vector.y(), vector.x()};
}

double acceleration_mps2(const Situation& situation) {
    return situation.stats.thrust_n / situation.stats.mass_kg;
}

// A waypoint an eighth of a turn on in the middle of the band when the straight way crosses the
// hole.
Vec2d around_the_hole(const Situation& situation, const Vec2d& goal) {
    const auto* ring = std::get_if<physics::Ring>(situation.platform);
    if (ring == nullptr) return goal;
    const Vec2d from = situation.own.position_m;
    const Vec2d way = goal - from;
    const double length2 = way.squaredNorm();
    if (length2 == 0.0) return goal;
    const double along = std::clamp(-from.dot(way) / length2, 0.0, 1.0);
    const double passes_at_m = (from + along * way).norm();
    if (passes_at_m >= ring->inner_radius_m + kEdgeMarginM) return goal;
    const Vec2d outward = unit_or_zero(from);
    Vec2d onward = perpendicular(outward);
    if (onward.dot(goal) < 0.0) onward = -onward;
    return unit_or_zero(outward + onward) * (ring->inner_radius_m + ring->outer_radius_m) / 2.0;
}

struct Motion {
    Vec2d position_m = Vec2d::Zero();
    Vec2d velocity_mps = Vec2d::Zero();
};

Motion after(const Situation& situation, const Intent& intent, double hold_s) {
    const SeenBall& own = situation.own;
    Vec2d velocity = own.velocity_mps + intent.thrust * (acceleration_mps2(situation) * hold_s);
    if (intent.dash) velocity += unit_or_zero(intent.thrust) * situation.stats.dash_speed_mps;
    const Vec2d mean_velocity = (own.velocity_mps + velocity) / 2.0;
    return {own.position_m + mean_velocity * hold_s, velocity};
}

// Smallest distance to the edge on the way that `velocity` and full braking lead to from `start`.
double room_on_the_way_m(const Situation& situation, const Vec2d& start, const Vec2d& velocity) {
    const double speed = velocity.norm();
    const double stopping_m = speed * speed / (2.0 * acceleration_mps2(situation));
    const Vec2d way = unit_or_zero(velocity) * stopping_m;
    double room_m = physics::distance_to_edge_m(*situation.platform, start);
    for (int i = 1; i <= kWaySamples; ++i) {
        const Vec2d point = start + way * (static_cast<double>(i) / kWaySamples);
        room_m = std::min(room_m, physics::distance_to_edge_m(*situation.platform, point));
    }
    return room_m;
}

}  // namespace

Vec2d unit_or_zero(const Vec2d& vector) {
    const double length = vector.norm();
    return length > 0.0 ? Vec2d(vector / length) : Vec2d(Vec2d::Zero());
}

const SeenBall* nearest_player(const Situation& situation) {
    const SeenBall* nearest = nullptr;
    double nearest_m2 = 0.0;
    for (const SeenBall& other : situation.others) {
        if (!other.is_player) continue;
        const double distance_m2 = (other.position_m - situation.own.position_m).squaredNorm();
        if (nearest != nullptr && distance_m2 >= nearest_m2) continue;
        nearest = &other;
        nearest_m2 = distance_m2;
    }
    return nearest;
}

Intent seek(const Situation& situation, const Vec2d& goal_m) {
    const Vec2d goal = around_the_hole(situation, goal_m);
    const Vec2d direction = unit_or_zero(goal - situation.own.position_m);
    const Vec2d velocity = situation.own.velocity_mps;
    const Vec2d sideways = velocity - velocity.dot(direction) * direction;
    const Vec2d wanted = direction - sideways * (kSidewaysGain / situation.stats.top_speed_mps);
    return {.thrust = unit_or_zero(wanted)};
}

Intent arrive(const Situation& situation, const Vec2d& goal_m) {
    const Vec2d way = goal_m - situation.own.position_m;
    const double distance_m = way.norm();
    const double speed = situation.own.velocity_mps.norm();
    const bool must_stop =
        speed * speed / (2.0 * acceleration_mps2(situation)) >= distance_m - kArrivedM;
    if (!must_stop) return seek(situation, goal_m);
    if (distance_m < kArrivedM && speed < kArrivedM) return {.brake = true};
    return {.thrust = -situation.own.velocity_mps / std::max(1.0, speed), .brake = true};
}

Intent rest(const Situation& situation) {
    if (const auto* ring = std::get_if<physics::Ring>(situation.platform)) {
        const Vec2d outward = unit_or_zero(situation.own.position_m);
        return arrive(situation, outward * (ring->inner_radius_m + ring->outer_radius_m) / 2.0);
    }
    const Vec2d place = situation.own.position_m;
    const double room_m = physics::distance_to_edge_m(*situation.platform, place);
    return arrive(situation, room_m >= kAtRestM ? place : Vec2d(place / 2.0));
}

Vec2d ghost_ball_m(const Situation& situation, const SeenBall& target, double standoff_m) {
    const Vec2d edge = physics::nearest_edge_point_m(*situation.platform, target.position_m);
    const Vec2d outward = unit_or_zero(edge - target.position_m);
    return target.position_m - outward * (situation.own.radius_m + target.radius_m + standoff_m);
}

bool leaves_room(const Situation& situation, const Intent& intent, double hold_s) {
    const Motion then = after(situation, intent, hold_s);
    return room_on_the_way_m(situation, then.position_m, then.velocity_mps) >= kEdgeMarginM;
}

Intent kept_on_platform(const Situation& situation, const Intent& intent, double hold_s) {
    if (leaves_room(situation, intent, hold_s)) return intent;

    const SeenBall& own = situation.own;
    const Vec2d position = after(situation, intent, hold_s).position_m;
    const Vec2d edge = physics::nearest_edge_point_m(*situation.platform, position);
    const bool is_off = physics::distance_to_edge_m(*situation.platform, position) < 0.0;
    const Vec2d inward = unit_or_zero(is_off ? edge - position : position - edge);
    const Vec2d back = inward - own.velocity_mps / situation.stats.top_speed_mps * 2.0;
    // Braking works against the way back as well, once the ball is on it.
    return {.thrust = unit_or_zero(back), .brake = own.velocity_mps.dot(inward) < 0.0};
}

}  // namespace fts::server::ai
