#include "client/bot/pilots/wanderer.h"

#include <array>

#include "client/bot/steering.h"

namespace fts::bot {
namespace {

constexpr std::array kWandererWants = {game::Stat::kTopSpeed, game::Stat::kBraking,
                                       game::Stat::kThrust};
constexpr double kArrivedM = 1.0;
constexpr double kPatienceS = 4.0;
constexpr int kTries = 50;

physics::Vec2d random_point_m(const physics::Platform& platform, Rng& rng) {
    const double reach_m = physics::bounding_radius_m(platform);
    for (int i = 0; i < kTries; ++i) {
        const double x = uniform(rng, -reach_m, reach_m);
        const double y = uniform(rng, -reach_m, reach_m);
        if (physics::distance_to_edge_m(platform, {x, y}) > 2.0 * kEdgeMarginM) return {x, y};
    }
    return innermost_point_m(platform, physics::Vec2d::UnitX());
}

}  // namespace

game::InputCommand Wanderer::decide(const Sight& sight, Rng& rng) {
    const auto helm = take_helm(sight);
    if (!helm) return {};
    const bool arrived = (goal_m_ - helm->position_m).norm() < kArrivedM;
    const bool off = physics::distance_to_edge_m(helm->platform, goal_m_) < kEdgeMarginM;
    if (arrived || off || sight.field.server_time_s >= give_up_at_s_) {
        goal_m_ = random_point_m(helm->platform, rng);
        give_up_at_s_ = sight.field.server_time_s + kPatienceS;
    }
    return stay_on(*helm, fly_to(*helm, goal_m_));
}

std::span<const game::Stat> Wanderer::shopping_list() const {
    return kWandererWants;
}

}  // namespace fts::bot
