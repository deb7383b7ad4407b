#include "common/game/upgrades.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fts::game {
namespace {

TEST(Upgrades, PricesFollowTheirFormula) {
    for (int tier = 0; tier < kMaxTier; ++tier) {
        EXPECT_EQ(price_coins(tier), std::lround(14.0 * std::pow(1.4, tier))) << "tier " << tier;
    }
    EXPECT_FALSE(price_coins(kMaxTier));
    EXPECT_FALSE(price_coins(-1));
}

TEST(Upgrades, EachTierChangesItsOwnQuantityAndNoOther) {
    const auto quantities = [](const BallStats& s) {
        return std::array{s.mass_kg,       s.thrust_n,        s.top_speed_mps,
                          s.braking_per_s, s.dash_recharge_s, s.magnet_range_m};
    };
    for (std::size_t stat = 0; stat < kStatCount; ++stat) {
        Tiers tiers{};
        auto before = quantities(stats_for(tiers));
        for (tiers[stat] = 1; tiers[stat] <= kMaxTier; ++tiers[stat]) {
            const auto after = quantities(stats_for(tiers));
            for (std::size_t other = 0; other < kStatCount; ++other) {
                EXPECT_EQ(after[other] != before[other], other == stat);
            }
            before = after;
        }
    }
}

TEST(Upgrades, MassCompoundsAndARechargeNeverVanishes) {
    EXPECT_NEAR(stats_for({6, 0, 0, 0, 0, 0}).mass_kg, std::pow(1.12, 6), 1e-12);
    EXPECT_GT(stats_for({0, 0, 0, 0, 6, 0}).dash_recharge_s, 1.0);
}

TEST(Upgrades, NamesGoBothWays) {
    for (std::size_t stat = 0; stat < kStatCount; ++stat) {
        EXPECT_EQ(stat_named(name_of(static_cast<Stat>(stat))), static_cast<Stat>(stat));
    }
    EXPECT_EQ(stat_named("top_speed"), Stat::kTopSpeed);
    EXPECT_FALSE(stat_named("restitution"));
    EXPECT_FALSE(stat_named(""));
}

TEST(Upgrades, TiersAboveTheLastAreInvalid) {
    EXPECT_TRUE(valid(Tiers{6, 6, 6, 6, 6, 6}));
    EXPECT_FALSE(valid(Tiers{0, 0, 7, 0, 0, 0}));
}

}  // namespace
}  // namespace fts::game
