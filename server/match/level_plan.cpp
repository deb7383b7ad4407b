#include "server/match/level_plan.h"

#include <algorithm>

#include "common/game/rules.h"
#include "common/game/upgrades.h"

namespace fts::server {
namespace {

constexpr game::Tiers kFullyUpgraded = {game::kMaxTier, game::kMaxTier, game::kMaxTier,
                                        game::kMaxTier, game::kMaxTier, game::kMaxTier};

physics::BodyDef dashing(double radius_m, double mass_kg, double speed_mps) {
    return {.velocity_mps = {speed_mps, 0.0}, .radius_m = radius_m, .mass_kg = mass_kg};
}

}  // namespace

physics::Scene fastest_scene_of(const game::Level& level, int players) {
    physics::Scene scene;
    scene.platform = level.platform;
    const game::BallStats best = game::stats_for(kFullyUpgraded);
    for (int i = 0; i < players; ++i) {
        scene.bodies.push_back(
            dashing(best.radius_m, best.mass_kg, best.top_speed_mps + best.dash_speed_mps));
    }
    for (const game::AiGroup& group : level.ai) {
        for (int i = 0; i < group.count; ++i) {
            scene.bodies.push_back(
                dashing(group.radius_m, group.mass_kg, group.top_speed_mps + best.dash_speed_mps));
        }
    }
    return scene;
}

physics::Plan plan_level(const game::Level& level, int players, double tolerance) {
    return physics::plan(fastest_scene_of(level, players),
                         {.tolerance = tolerance,
                          .tick_duration_s = 1.0 / game::kTickRateHz,
                          .allow_float = false,
                          .thrust = true});
}

std::vector<physics::Plan> plan_levels(const std::vector<game::Level>& levels, int players,
                                       double tolerance) {
    std::vector<physics::Plan> plans;
    plans.reserve(levels.size());
    for (const game::Level& level : levels) {
        plans.push_back(plan_level(level, players, tolerance));
    }
    return plans;
}

std::vector<std::string> describe_levels(const std::vector<physics::Plan>& plans) {
    std::vector<std::string> lines;
    for (std::size_t first = 0; first < plans.size();) {
        std::size_t last = first;
        while (last + 1 < plans.size() && describe(plans[last + 1]) == describe(plans[first])) {
            ++last;
        }
        const std::string which = last == first ? "level " + std::to_string(first + 1)
                                                : "levels " + std::to_string(first + 1) + " to " +
                                                      std::to_string(last + 1);
        // Of levels that share a plan the one with the largest error speaks for all.
        const auto worst = std::max_element(plans.begin() + static_cast<std::ptrdiff_t>(first),
                                            plans.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                                            [](const physics::Plan& a, const physics::Plan& b) {
                                                return a.error_bound < b.error_bound;
                                            });
        lines.push_back(which + ": " + describe(*worst) + ". " + worst->reason);
        first = last + 1;
    }
    return lines;
}

}  // namespace fts::server
