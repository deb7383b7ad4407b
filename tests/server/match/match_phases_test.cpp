#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/match/match_bench.h"

namespace fts::server {
namespace {

using game::Phase;
using replication::LevelEnded;
using replication::LevelOutcome;
using replication::LevelStarted;

constexpr int kSecond = game::kTickRateHz;
constexpr game::InputCommand kEast{.thrust_x = 127};

std::vector<game::Level> two_levels() {
    return {quiet_level(1, physics::Disc{8.0}), quiet_level(2, physics::Disc{9.0}, 2)};
}

// Runs off the edge until the level is over.
void lose_the_level(MatchBench& bench, PlayerId player) {
    bench.match.set_input(player, kEast);
    bench.tick_until(Phase::kShop);
}

TEST(Match, waits_and_does_not_tick_while_nobody_is_there) {
    MatchBench bench(two_levels());
    const auto before = hash_of(bench.match.snapshot());
    bench.tick(1000);
    EXPECT_EQ(bench.match.phase(), Phase::kWaiting);
    EXPECT_EQ(hash_of(bench.match.snapshot()), before);
    EXPECT_EQ(bench.match.totals().ticks, 0u);
    EXPECT_TRUE(bench.match.drain_outgoing().empty());
}

TEST(Match, counts_three_seconds_down_in_which_nothing_moves) {
    MatchBench bench(two_levels());
    const PlayerId player = bench.join(1);
    bench.match.set_input(player, kEast);
    const auto start = bench.match.snapshot();
    ASSERT_EQ(start.balls.size(), 2u);
    bench.tick(3 * kSecond - 1);
    EXPECT_EQ(bench.match.phase(), Phase::kCountdown);
    EXPECT_EQ(bench.match.snapshot().balls, start.balls);
    bench.tick();
    EXPECT_EQ(bench.match.phase(), Phase::kPlaying);
    bench.tick(10);
    EXPECT_GT(bench.ball_of(player)->vx, 0);
}

TEST(Match, briefs_whoever_joins_with_level_roster_and_wallet) {
    MatchBench bench(two_levels());
    const PlayerId player = bench.join(1, 17);
    const auto briefing = bench.match.briefing(player);
    ASSERT_EQ(briefing.size(), 3u);
    const auto& level = std::get<LevelStarted>(briefing[0]);
    EXPECT_EQ(level.number, 1);
    EXPECT_EQ(level.level_count, 2);
    EXPECT_EQ(level.ai_balls, 1);
    const auto& roster = std::get<replication::Roster>(briefing[1]);
    ASSERT_EQ(roster.players.size(), 1u);
    EXPECT_EQ(roster.players[0].player_id, player);
    EXPECT_EQ(roster.players[0].lives, game::kLivesPerLevel);
    EXPECT_EQ(std::get<replication::Wallet>(briefing[2]).coins, 17);
    EXPECT_TRUE(bench.match.briefing(99).empty());
}

TEST(Match, gives_a_ball_at_once_to_whoever_joins_a_level_in_play) {
    MatchBench bench(two_levels());
    bench.join(1);
    bench.tick_until(Phase::kPlaying);
    const PlayerId late = bench.join(2);
    EXPECT_TRUE(bench.ball_of(late).has_value());
}

TEST(Match, refuses_players_beyond_its_room_and_never_reuses_an_id) {
    MatchBench bench(two_levels(), 1, 2);
    bench.join(1);
    const PlayerId second = bench.join(2);
    PlayerRecord record;
    record.key = key_of(3);
    bench.ledger.load(record);
    EXPECT_FALSE(bench.match.has_room());
    EXPECT_FALSE(bench.match.join(key_of(3), "third").has_value());
    bench.match.leave(second);
    EXPECT_GT(bench.join(3), second);
}

TEST(Match, keeps_the_score_of_a_player_who_comes_back) {
    MatchBench bench(two_levels());
    const PlayerId player = bench.join(1);
    bench.join(2);
    bench.match.set_input(player, kEast);
    while (bench.score_of(player).falls == 0) bench.tick();
    bench.match.leave(player);
    EXPECT_EQ(bench.match.scoreboard().size(), 2u);
    const PlayerId again = bench.join(1);
    EXPECT_EQ(bench.match.scoreboard().size(), 2u);
    EXPECT_EQ(bench.score_of(again).falls, 1);
}

TEST(Match, respawns_a_fallen_player_after_two_seconds_while_lives_remain) {
    MatchBench bench(two_levels());
    const PlayerId player = bench.join(1);
    bench.match.set_input(player, kEast);
    while (bench.score_of(player).falls == 0) bench.tick();
    EXPECT_FALSE(bench.ball_of(player).has_value());
    bench.match.set_input(player, {});
    bench.tick(2 * kSecond - 1);
    EXPECT_FALSE(bench.ball_of(player).has_value());
    bench.tick();
    EXPECT_TRUE(bench.ball_of(player).has_value());
}

TEST(Match, loses_the_level_when_all_players_are_out_of_lives_and_plays_it_again) {
    MatchBench bench(two_levels());
    const PlayerId player = bench.join(1);
    lose_the_level(bench, player);
    EXPECT_EQ(bench.score_of(player).falls, game::kLivesPerLevel);
    const auto ended = bench.said<LevelEnded>(player);
    ASSERT_EQ(ended.size(), 1u);
    EXPECT_EQ(ended[0].outcome, LevelOutcome::kLost);
    EXPECT_EQ(bench.match.totals().levels_lost, 1);
    bench.match.set_ready(player);
    bench.tick();
    EXPECT_EQ(bench.match.phase(), Phase::kCountdown);
    EXPECT_EQ(bench.match.level_number(), 1);
    EXPECT_TRUE(bench.ball_of(player).has_value());
}

TEST(Match, goes_on_while_one_of_two_players_has_lives) {
    MatchBench bench(two_levels());
    const PlayerId reckless = bench.join(1), careful = bench.join(2);
    bench.match.set_input(reckless, kEast);
    bench.tick(40 * kSecond);
    EXPECT_EQ(bench.score_of(reckless).falls, game::kLivesPerLevel);
    EXPECT_FALSE(bench.ball_of(reckless).has_value());
    EXPECT_EQ(bench.match.phase(), Phase::kPlaying);
    bench.match.leave(careful);
    bench.tick();
    EXPECT_EQ(bench.match.phase(), Phase::kShop);
}

TEST(Match, does_not_renew_the_lives_of_a_player_who_comes_back) {
    MatchBench bench(two_levels());
    const PlayerId reckless = bench.join(1);
    bench.join(2);
    bench.match.set_input(reckless, kEast);
    bench.tick_until(Phase::kPlaying);
    while (bench.score_of(reckless).falls < game::kLivesPerLevel) bench.tick();
    bench.match.leave(reckless);
    const PlayerId again = bench.join(1);
    bench.tick(5 * kSecond);
    EXPECT_FALSE(bench.ball_of(again).has_value());
}

TEST(Match, ends_a_level_at_its_time_limit) {
    auto levels = two_levels();
    levels[0].time_limit_s = 10.0;
    MatchBench bench(levels);
    const PlayerId player = bench.join(1);
    bench.tick((3 + 10) * kSecond - 1);
    EXPECT_EQ(bench.match.phase(), Phase::kPlaying);
    bench.tick();
    EXPECT_EQ(bench.match.phase(), Phase::kShop);
    ASSERT_EQ(bench.said<LevelEnded>(player).size(), 1u);
    EXPECT_EQ(bench.said<LevelEnded>(player)[0].outcome, LevelOutcome::kTimeUp);
}

TEST(Match, keeps_the_shop_open_for_twenty_seconds_or_until_all_are_ready) {
    auto levels = two_levels();
    levels[0].time_limit_s = 10.0;
    MatchBench bench(levels);
    const PlayerId first = bench.join(1), second = bench.join(2);
    bench.tick_until(Phase::kShop);
    EXPECT_TRUE(bench.match.shop_is_open());
    bench.match.set_ready(first);
    bench.tick(20 * kSecond - 1);
    EXPECT_EQ(bench.match.phase(), Phase::kShop);
    bench.tick();
    EXPECT_EQ(bench.match.phase(), Phase::kCountdown);
    EXPECT_FALSE(bench.match.shop_is_open());

    bench.tick_until(Phase::kShop);
    bench.match.set_ready(first);
    bench.match.set_ready(second);
    bench.tick();
    EXPECT_EQ(bench.match.phase(), Phase::kCountdown);
    EXPECT_EQ(bench.said<LevelStarted>().size(), 1u);
}

TEST(Match, stands_still_while_the_shop_is_open) {
    auto levels = two_levels();
    levels[0].time_limit_s = 10.0;
    levels[0].ai[0].thrust_n = 4.0;
    MatchBench bench(levels);
    bench.match.set_input(bench.join(1), {.thrust_x = 20});
    bench.tick_until(Phase::kShop);
    const auto closed = bench.match.snapshot();
    for (const auto& ball : closed.balls) EXPECT_EQ(velocity_of(ball), physics::Vec2d(0.0, 0.0));
    bench.tick(60);
    EXPECT_EQ(bench.match.snapshot().balls, closed.balls);
}

TEST(Match, pauses_when_the_last_player_leaves_and_resets_the_level_for_the_next) {
    MatchBench bench(two_levels());
    const PlayerId player = bench.join(1);
    bench.match.set_input(player, kEast);
    bench.tick(5 * kSecond);
    bench.match.leave(player);
    EXPECT_EQ(bench.match.phase(), Phase::kWaiting);
    EXPECT_TRUE(bench.match.snapshot().balls.empty());
    const auto paused = hash_of(bench.match.snapshot());
    bench.tick(500);
    EXPECT_EQ(hash_of(bench.match.snapshot()), paused);

    const PlayerId next = bench.join(2);
    EXPECT_EQ(bench.match.phase(), Phase::kCountdown);
    EXPECT_EQ(bench.match.level_number(), 1);
    EXPECT_EQ(bench.match.snapshot().balls.size(), 2u);
    EXPECT_TRUE(bench.ball_of(next).has_value());
}

TEST(Match, passes_chat_on_to_all_and_cuts_it_between_characters) {
    MatchBench bench(two_levels());
    const PlayerId player = bench.join(1);
    std::string text;
    while (text.size() < 200) text += "ü";
    bench.match.chat(player, "x" + text);
    bench.match.chat(77, "who am I?");
    bench.tick();
    const auto lines = bench.said<replication::ChatLine>();
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].player_id, player);
    EXPECT_EQ(lines[0].text, ("x" + text).substr(0, 159));
}

TEST(Match, tells_the_roster_when_it_changes_and_not_otherwise) {
    MatchBench bench(two_levels());
    bench.join(1);
    bench.tick();
    EXPECT_EQ(bench.said<replication::Roster>().size(), 1u);
    bench.tick(3 * kSecond);
    EXPECT_TRUE(bench.said<replication::Roster>().empty());
    const PlayerId second = bench.join(2);
    bench.tick(kSecond);
    const auto told = bench.said<replication::Roster>();
    ASSERT_EQ(told.size(), 1u);
    ASSERT_EQ(told[0].players.size(), 2u);
    EXPECT_EQ(told[0].players[1].player_id, second);
    EXPECT_NE(told[0].players[0].colour, told[0].players[1].colour);
}

}  // namespace
}  // namespace fts::server
