#include <gtest/gtest.h>

#include "tests/server/match/match_bench.h"

namespace fts::server {
namespace {

using game::Phase;
using physics::Vec2d;
using replication::KnockOff;
using replication::LevelEnded;
using replication::LevelOutcome;

constexpr game::InputCommand kEast{.thrust_x = 127};

void push_off_all_ai(MatchBench& bench, PlayerId player) {
    bench.tick_until(Phase::kPlaying);
    for (int tick = 0; tick < 60 * 110 && bench.match.phase() == Phase::kPlaying; ++tick) {
        bench.match.set_input(player, ram(bench.match.snapshot(), player, Prey::kAi));
        bench.tick();
    }
}

TEST(MatchCoins, clearing_a_level_pays_the_knock_off_and_six_coins_to_everybody_present) {
    MatchBench bench({quiet_level(1, physics::Disc{6.0}), quiet_level(2, physics::Disc{6.0})});
    const PlayerId player = bench.join(1), spectator = bench.join(2);
    bench.tick_until(Phase::kPlaying);
    bench.match.set_input(spectator, kEast);
    push_off_all_ai(bench, player);
    ASSERT_EQ(bench.match.phase(), Phase::kShop);
    ASSERT_EQ(bench.match.totals().levels_cleared, 1);
    const auto ended = bench.said<LevelEnded>(player);
    ASSERT_EQ(ended.size(), 1u);
    EXPECT_EQ(ended[0].outcome, LevelOutcome::kCleared);
    EXPECT_EQ(ended[0].coins_earned, bench.score_of(player).coins_earned);
    EXPECT_GE(bench.score_of(spectator).coins_earned, game::kLevelClearCoins);

    bench.match.set_ready(player);
    bench.match.set_ready(spectator);
    bench.tick();
    EXPECT_EQ(bench.match.level_number(), 2);
}

TEST(MatchCoins, a_knock_off_pays_what_the_level_is_worth_to_whom_it_belongs) {
    MatchBench bench({quiet_level(1, physics::Disc{6.0})});
    const PlayerId player = bench.join(1);
    push_off_all_ai(bench, player);
    const auto news = bench.said<KnockOff>();
    ASSERT_EQ(news.size(), 1u);
    EXPECT_EQ(news[0].victim_player, 0);
    ASSERT_EQ(news[0].shares.size(), 1u);
    EXPECT_EQ(news[0].shares[0].player_id, player);
    EXPECT_EQ(news[0].shares[0].coins, game::knock_off_coins(1));
    EXPECT_FALSE(news[0].shares[0].assist);
    EXPECT_EQ(bench.score_of(player).knock_offs, 1);
    EXPECT_EQ(bench.ledger.coins(key_of(1)), game::knock_off_coins(1) + game::kLevelClearCoins);
    EXPECT_EQ(bench.match.totals().ai_knock_offs, 1u);
}

TEST(MatchCoins, running_into_one_ball_and_then_another_does_not_halve_the_pay) {
    int in_full = 0, knock_offs = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        MatchBench bench({quiet_level(1, physics::Disc{5.0}, 4)}, seed);
        const PlayerId player = bench.join(1);
        bench.tick_until(Phase::kPlaying);
        while (bench.match.phase() == Phase::kPlaying) {
            bench.match.set_input(player, ram(bench.match.snapshot(), player, Prey::kAi));
            bench.tick();
            for (const auto& news : bench.said<KnockOff>()) {
                if (news.shares.empty()) continue;
                ++knock_offs;
                in_full += news.shares[0].coins == game::knock_off_coins(1);
            }
        }
    }
    EXPECT_GE(knock_offs, 20);
    EXPECT_GT(in_full, knock_offs * 9 / 10) << "only balls that came at the player take a share";
}

TEST(MatchCoins, the_campaign_begins_again_after_its_last_level) {
    MatchBench bench({quiet_level(1, physics::Disc{6.0})});
    const PlayerId player = bench.join(1);
    push_off_all_ai(bench, player);
    ASSERT_EQ(bench.said<LevelEnded>(player).size(), 1u);
    EXPECT_EQ(bench.said<LevelEnded>(player)[0].outcome, LevelOutcome::kCampaignComplete);
    bench.match.set_ready(player);
    bench.tick();
    EXPECT_EQ(bench.match.phase(), Phase::kCountdown);
    EXPECT_EQ(bench.match.level_number(), 1);
}

struct DropCase {
    int held, dropped;
};
class FallenPlayer : public ::testing::TestWithParam<DropCase> {};

TEST_P(FallenPlayer, drops_a_tenth_of_the_coins_and_at_most_five_onto_the_platform) {
    const physics::Platform platform = physics::Disc{8.0};
    MatchBench bench({quiet_level(1, platform)});
    const PlayerId player = bench.join(1, GetParam().held);
    bench.match.set_input(player, kEast);
    while (bench.score_of(player).falls == 0) bench.tick();
    EXPECT_EQ(bench.ledger.coins(key_of(1)), GetParam().held - GetParam().dropped);
    EXPECT_EQ(bench.ledger.field_coins(0), GetParam().dropped);
    const auto coins = bench.match.snapshot().coins;
    EXPECT_EQ(coins.size(), static_cast<std::size_t>(GetParam().dropped));
    for (const auto& coin : coins) {
        const Vec2d point(coin.x * replication::kPositionStepM,
                          coin.y * replication::kPositionStepM);
        EXPECT_GT(physics::distance_to_edge_m(platform, point), 0.0);
        EXPECT_LT(physics::distance_to_edge_m(platform, point), 3.0);
    }
}
INSTANTIATE_TEST_SUITE_P(All, FallenPlayer,
                         ::testing::Values(DropCase{0, 0}, DropCase{9, 0}, DropCase{10, 1},
                                           DropCase{39, 3}, DropCase{50, 5}, DropCase{999, 5}));

TEST(MatchCoins, field_coins_lie_on_the_platform_and_are_swept_when_the_level_ends) {
    auto level = quiet_level(1, physics::Ring{3.0, 9.0});
    level.field_coins = 20;
    level.time_limit_s = 10.0;
    MatchBench bench({level});
    bench.join(1);
    EXPECT_EQ(bench.ledger.field_coins(0), 20);
    EXPECT_EQ(bench.match.snapshot().coins.size(), 20u);
    bench.tick_until(Phase::kShop);
    EXPECT_EQ(bench.ledger.field_coins(0), 0);
    EXPECT_TRUE(bench.match.snapshot().coins.empty());
}

TEST(MatchCoins, a_coin_within_the_magnets_range_is_picked_up) {
    auto level = quiet_level(1, physics::Disc{3.0});
    level.field_coins = 200;
    MatchBench bench({level});
    const PlayerId player = bench.join(1);
    bench.tick_until(Phase::kPlaying);
    bench.tick();
    const auto snapshot = bench.match.snapshot();
    EXPECT_LT(snapshot.coins.size(), 200u);
    EXPECT_EQ(bench.ledger.coins(key_of(1)), 200 - static_cast<int>(snapshot.coins.size()));
    EXPECT_EQ(bench.score_of(player).coins_earned, bench.ledger.coins(key_of(1)));
    const auto stats = game::stats_for({});
    const Vec2d own = position_of(*bench.ball_of(player));
    for (const auto& coin : snapshot.coins) {
        const Vec2d point(coin.x * replication::kPositionStepM,
                          coin.y * replication::kPositionStepM);
        EXPECT_GT((point - own).norm(), stats.radius_m + stats.magnet_range_m - 0.002);
    }
}

TEST(MatchCoins, knocking_off_a_rival_pays_as_an_ai_ball_does) {
    MatchBench bench({quiet_level(1, physics::Disc{6.0})}, 3);
    const PlayerId hunter = bench.join(1), prey = bench.join(2);
    bench.tick_until(Phase::kPlaying);
    std::vector<KnockOff> news;
    for (int tick = 0; tick < 60 * 60 && bench.score_of(prey).falls == 0; ++tick) {
        const auto own = bench.ball_of(hunter), target = bench.ball_of(prey);
        game::InputCommand input;
        if (own && target)
            input = game::command_toward((position_of(*target) - position_of(*own)).normalized() -
                                         0.1 * velocity_of(*own));
        bench.match.set_input(hunter, input);
        bench.tick();
        for (const auto& one : bench.said<KnockOff>()) news.push_back(one);
    }
    ASSERT_FALSE(news.empty());
    const auto& last = news.back();
    EXPECT_EQ(last.victim_player, prey);
    ASSERT_EQ(last.shares.size(), 1u);
    EXPECT_EQ(last.shares[0].player_id, hunter);
    EXPECT_EQ(last.shares[0].coins, game::knock_off_coins(1));
    EXPECT_EQ(bench.score_of(hunter).knock_offs, 1);
}

}  // namespace
}  // namespace fts::server
