#include "client/bot/pilots/chaser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "client/bot/steering.h"

namespace fts::bot {
namespace {

using physics::Vec2d;

constexpr std::array kChaserWants = {game::Stat::kMass, game::Stat::kThrust, game::Stat::kTopSpeed,
                                     game::Stat::kDash, game::Stat::kBraking};
// A target is given up for another one only when that is this much easier.
constexpr double kLoyalty = 0.7;
// No plan looks further ahead.
constexpr double kMaxLookAheadS = 1.0;
// Run-up behind the target.
constexpr double kRunUpM = 1.5;
// How well the way to the target must agree with the way to the edge to charge: cos 50 and 20
// degrees.
constexpr double kBehindCosine = 0.64;
constexpr double kAlignedCosine = 0.94;
// Contact nearer than this: the blow stops the ball, so the edge behind the target is no danger.
constexpr double kCommittedS = 0.25;
constexpr double kDashGapM = 1.5;

struct Plan {
    Vec2d target_m = Vec2d::Zero();  // at contact
    Vec2d push = Vec2d::UnitX();     // unit, towards the edge
    double reach_m = 0.0;            // distance of the centres at contact
};

Vec2d push_direction(const physics::Platform& platform, const Vec2d& target_m) {
    const Vec2d edge_m = physics::nearest_edge_point_m(platform, target_m);
    const bool on = physics::distance_to_edge_m(platform, target_m) >= 0.0;
    const Vec2d way = on ? Vec2d(edge_m - target_m) : Vec2d(target_m - edge_m);
    if (way.norm() > 1e-9) return way.normalized();
    return target_m.norm() > 1e-9 ? Vec2d(target_m.normalized()) : Vec2d(Vec2d::UnitX());
}

Plan plan_for(const Helm& helm, const FieldBall& target) {
    Plan plan;
    plan.reach_m = helm.radius_m + target.radius_m;
    double contact_s = 0.0;
    // The time to contact depends on where it will be: two rounds settle it well enough.
    for (int round = 0; round < 2; ++round) {
        plan.target_m = ahead(helm, target, contact_s);
        plan.push = push_direction(helm.platform, plan.target_m);
        const Vec2d ghost_m = plan.target_m - plan.push * plan.reach_m;
        const double speed_mps = std::max(helm.velocity_mps.norm(), 0.5 * helm.top_speed_mps);
        contact_s = std::min((ghost_m - helm.position_m).norm() / speed_mps, kMaxLookAheadS);
    }
    return plan;
}

game::InputCommand charge(const Helm& helm, const FieldBall& target, const Plan& plan) {
    const Vec2d ghost_m = plan.target_m - plan.push * plan.reach_m;
    const Vec2d to_ghost_m = ghost_m - helm.position_m;
    const Vec2d to_target = (plan.target_m - helm.position_m).normalized();
    const Vec2d heading = to_ghost_m.norm() > 0.2 ? Vec2d(to_ghost_m.normalized()) : to_target;
    game::InputCommand command = fly_at(helm, heading * helm.top_speed_mps);

    const double gap_m = (ahead(helm, target, 0.0) - helm.position_m).norm() - plan.reach_m;
    const double closing_mps = (helm.velocity_mps - target.velocity_mps).dot(to_target);
    const bool aligned = to_target.dot(plan.push) > kAlignedCosine;
    const bool committed = aligned && closing_mps > 0.0 && gap_m < closing_mps * kCommittedS &&
                           helm.mass_kg < 1.5 * target.mass_kg;
    command.dash = aligned && gap_m < kDashGapM && closing_mps > 0.0;
    return committed ? command : stay_on(helm, command);
}

// Behind the target, in an arc that does not touch it.
game::InputCommand go_behind(const Helm& helm, const Plan& plan) {
    const Vec2d from_target_m = helm.position_m - plan.target_m;
    const double clear_m = plan.reach_m + kRunUpM;
    const double side = from_target_m.x() * plan.push.y() - from_target_m.y() * plan.push.x();
    const Vec2d across = (side >= 0.0 ? 1.0 : -1.0) * Vec2d(plan.push.y(), -plan.push.x());
    const bool in_front = from_target_m.dot(plan.push) > 0.0;
    const Vec2d waypoint_m = in_front ? Vec2d(plan.target_m + across * clear_m)
                                      : Vec2d(plan.target_m - plan.push * clear_m);
    return stay_on(helm, fly_to(helm, waypoint_m));
}

// How far there is to go to get at a ball and push it off, as if both had the same mass.
double effort_m(const FieldBall& own, const FieldBall& ball) {
    const double way_m = (ball.position_m - own.position_m).norm();
    const double push_m = std::max(0.0, ball.to_edge_m);
    return way_m + push_m * std::max(1.0, ball.mass_kg / std::max(own.mass_kg, 1e-6));
}

}  // namespace

const FieldBall* Chaser::choose_target(const Sight& sight) {
    const FieldBall* best = nullptr;
    double best_effort_m = std::numeric_limits<double>::infinity();
    for (const FieldBall& ball : sight.field.ai_balls) {
        const double loyalty = target_id_ == ball.id ? kLoyalty : 1.0;
        const double effort = loyalty * effort_m(*sight.own, ball);
        if (effort < best_effort_m) {
            best = &ball;
            best_effort_m = effort;
        }
    }
    target_id_ = best == nullptr ? std::nullopt : std::optional(best->id);
    return best;
}

game::InputCommand Chaser::decide(const Sight& sight, Rng&) {
    const auto helm = take_helm(sight);
    if (!helm) return {};
    const FieldBall* target = choose_target(sight);
    if (target == nullptr) {
        return stay_on(*helm, fly_to(*helm, innermost_point_m(helm->platform, helm->position_m)));
    }
    const Plan plan = plan_for(*helm, *target);
    const Vec2d to_target_m = plan.target_m - helm->position_m;
    const bool behind = to_target_m.dot(plan.push) > kBehindCosine * to_target_m.norm();
    return behind ? charge(*helm, *target, plan) : go_behind(*helm, plan);
}

std::span<const game::Stat> Chaser::shopping_list() const {
    return kChaserWants;
}

}  // namespace fts::bot
