#include "server/match/level_plan.h"

#include <gtest/gtest.h>

#include "server/match/level_file.h"

namespace fts::server {
namespace {

constexpr int kPlayers = 8;

std::vector<game::Level> shipped_levels() {
    LoadedLevels loaded = load_levels(FTS_LEVELS_DIR);
    EXPECT_EQ(loaded.error, "");
    return loaded.levels;
}

TEST(LevelPlan, every_shipped_level_is_played_exactly_unless_the_host_asks_for_less) {
    const auto plans = plan_levels(shipped_levels(), kPlayers, physics::kAutoTolerance);
    ASSERT_GE(plans.size(), 5U);
    for (const physics::Plan& plan : plans) {
        EXPECT_EQ(plan.solver.kind, physics::SolverKind::kSwept);
        EXPECT_EQ(plan.scalar, physics::ScalarKind::kDouble);
        EXPECT_LE(plan.error_bound, physics::kAutoTolerance);
    }
    const auto lines = describe_levels(plans);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(
        lines.front().rfind("levels 1 to " + std::to_string(plans.size()) + ": swept, double", 0),
        0U)
        << lines.front();
}

TEST(LevelPlan, the_scene_it_judges_holds_everybody_at_their_fastest) {
    const game::Level level = shipped_levels().back();
    const physics::Scene scene = fastest_scene_of(level, kPlayers);
    std::size_t balls = kPlayers;
    for (const game::AiGroup& group : level.ai) balls += static_cast<std::size_t>(group.count);
    EXPECT_EQ(scene.bodies.size(), balls);
    for (const physics::BodyDef& body : scene.bodies) EXPECT_GT(body.velocity_mps.norm(), 1.0);
    EXPECT_FALSE(validate(scene, physics::Overlaps::kAccepted));
}

TEST(LevelPlan, fast_states_an_error_that_its_tolerance_allows) {
    for (const physics::Plan& plan :
         plan_levels(shipped_levels(), kPlayers, physics::kFastTolerance)) {
        EXPECT_TRUE(plan.meets_tolerance);
        EXPECT_LE(plan.error_bound, physics::kFastTolerance);
        EXPECT_EQ(plan.scalar, physics::ScalarKind::kDouble);
        EXPECT_NE(plan.solver.kind, physics::SolverKind::kEvent) << "players thrust";
    }
}

TEST(LevelPlan, levels_that_share_a_plan_share_a_line) {
    std::vector<physics::Plan> plans(4);
    plans[2].solver = {physics::SolverKind::kDiscrete, 3};
    const auto lines = describe_levels(plans);
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(lines[0].rfind("levels 1 to 2: swept", 0), 0U) << lines[0];
    EXPECT_EQ(lines[1].rfind("level 3: discrete, double, 3 substeps", 0), 0U) << lines[1];
    EXPECT_EQ(lines[2].rfind("level 4: swept", 0), 0U) << lines[2];
}

}  // namespace
}  // namespace fts::server
