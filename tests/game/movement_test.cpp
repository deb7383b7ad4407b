#include "common/game/movement.h"

#include <gtest/gtest.h>

#include "common/game/rules.h"

namespace fts::game {
namespace {

const InputCommand kFullRight{.thrust_x = 127};

TEST(Movement, FullThrustTendsToTheTopSpeedWhateverTheMass) {
    for (std::uint8_t tier = 0; tier <= kMaxTier; ++tier) {
        const BallStats stats = stats_for({tier, 0, 0, 0, 0, 0});
        const auto control = control_for(handling_of(stats), kFullRight);
        EXPECT_NEAR(control.acceleration_mps2.norm() / control.drag_per_s, stats.top_speed_mps,
                    1e-12);
    }
}

TEST(Movement, AHeavierBallCoastsFurther) {
    const auto light = control_for(handling_of(stats_for({0, 0, 0, 0, 0, 0})), {});
    const auto heavy = control_for(handling_of(stats_for({6, 0, 0, 0, 0, 0})), {});
    EXPECT_LT(heavy.drag_per_s, light.drag_per_s);
    EXPECT_TRUE(light.acceleration_mps2.isZero());
}

TEST(Movement, BrakingAddsItsDragAndBuysMore) {
    const BallStats base = stats_for({});
    const BallStats better = stats_for({0, 0, 0, 6, 0, 0});
    const InputCommand brake{.brake = true};
    EXPECT_DOUBLE_EQ(control_for(handling_of(base), brake).drag_per_s,
                     control_for(handling_of(base), {}).drag_per_s + base.braking_per_s);
    EXPECT_GT(control_for(handling_of(better), brake).drag_per_s,
              control_for(handling_of(base), brake).drag_per_s);
}

TEST(Movement, ADashFiresOnceAndAgainOnlyWhenRecharged) {
    const BallStats stats = stats_for({});
    const InputCommand dash{.thrust_x = 0, .thrust_y = 90, .dash = true};
    DashState state;
    int ticks_between = 0;
    ASSERT_TRUE(advance_dash(state, stats, dash, kTickRateHz));
    bool again = false;
    while (!again && ticks_between < 10'000) {
        again = advance_dash(state, stats, dash, kTickRateHz);
        ++ticks_between;
    }
    ASSERT_TRUE(again);
    EXPECT_EQ(ticks_between, static_cast<int>(stats.dash_recharge_s * kTickRateHz));
}

TEST(Movement, ADashGoesAlongTheThrustHoweverWeakThatIs) {
    const Handling handling = handling_of(stats_for({}));
    const physics::Vec2d gained_mps = dash_for(handling, {.thrust_x = 0, .thrust_y = 90});
    EXPECT_NEAR(gained_mps.norm(), handling.dash_mps, 1e-12);
    EXPECT_EQ(gained_mps.x(), 0.0);
    EXPECT_EQ(dash_for(handling, {.thrust_y = 1}), gained_mps);
    EXPECT_TRUE(dash_for(handling, {}).isZero());
}

TEST(Movement, ADashWithoutADirectionWaitsForOne) {
    const BallStats stats = stats_for({});
    DashState state;
    EXPECT_FALSE(advance_dash(state, stats, {.dash = true}, kTickRateHz));
    EXPECT_TRUE(advance_dash(state, stats, {.thrust_x = 1, .dash = true}, kTickRateHz));
}

TEST(Rules, AKnockOffPaysMoreOnLaterLevels) {
    EXPECT_EQ(knock_off_coins(1), 4);
    EXPECT_EQ(knock_off_coins(2), 4);
    EXPECT_EQ(knock_off_coins(3), 5);
    EXPECT_EQ(knock_off_coins(6), 6);
    for (int level = 1; level < 100; ++level) {
        EXPECT_LE(knock_off_coins(level), knock_off_coins(level + 1));
    }
}

}  // namespace
}  // namespace fts::game
