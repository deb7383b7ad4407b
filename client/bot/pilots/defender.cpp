#include "client/bot/pilots/defender.h"

#include <array>

#include "client/bot/steering.h"

namespace fts::bot {
namespace {

using physics::Vec2d;

constexpr std::array kDefenderWants = {game::Stat::kMass, game::Stat::kBraking,
                                       game::Stat::kThrust};
// A ball that could touch within this time is met.
constexpr double kAlarmS = 0.8;
// Only as long as home is this near.
constexpr double kLeashM = 3.0;

struct Threat {
    Vec2d direction = Vec2d::Zero();
    double contact_s = kAlarmS;
};

std::optional<Threat> nearest_threat(const Sight& sight, const Helm& helm) {
    std::optional<Threat> nearest;
    for (const FieldBall& ball : sight.field.ai_balls) {
        const Vec2d apart_m = ahead(helm, ball, 0.0) - helm.position_m;
        const double distance_m = apart_m.norm();
        if (distance_m < 1e-6) continue;
        const Vec2d direction = apart_m / distance_m;
        const double closing_mps = (helm.velocity_mps - ball.velocity_mps).dot(direction);
        const double gap_m = std::max(0.0, distance_m - helm.radius_m - ball.radius_m);
        if (closing_mps <= 0.0) continue;
        const double contact_s = gap_m / closing_mps;
        if (contact_s < (nearest ? nearest->contact_s : kAlarmS)) nearest = {direction, contact_s};
    }
    return nearest;
}

}  // namespace

game::InputCommand Defender::decide(const Sight& sight, Rng&) {
    const auto helm = take_helm(sight);
    if (!helm) return {};
    const Vec2d home_m = innermost_point_m(helm->platform, helm->position_m);
    const auto threat = nearest_threat(sight, *helm);
    if (threat && (home_m - helm->position_m).norm() < kLeashM) {
        game::InputCommand blow = fly_at(*helm, threat->direction * helm->top_speed_mps);
        blow.dash = true;
        return stay_on(*helm, blow);
    }
    return stay_on(*helm, fly_to(*helm, home_m));
}

std::span<const game::Stat> Defender::shopping_list() const {
    return kDefenderWants;
}

}  // namespace fts::bot
