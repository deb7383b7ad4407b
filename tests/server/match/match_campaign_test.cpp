// A scripted player with base stats against the shipped levels: what a beginner can expect.
#include <algorithm>

#include <gtest/gtest.h>

#include "server/match/level_file.h"
#include "tests/server/match/match_bench.h"

namespace fts::server {
namespace {

using game::Phase;
using physics::Vec2d;

constexpr int kDecisionTicks = 9;  // 150 ms: a person's reaction, roughly

// Runs straight at the nearest AI ball and stops before the edge; that is all it knows.
game::InputCommand simple_chase(const replication::Snapshot& snapshot, PlayerId player,
                                const physics::Platform& platform) {
    const auto own = std::find_if(snapshot.balls.begin(), snapshot.balls.end(),
                                  [player](const auto& ball) { return ball.player_id == player; });
    if (own == snapshot.balls.end()) return {};
    const Vec2d position = position_of(*own), velocity = velocity_of(*own);
    Vec2d way = Vec2d::Zero();
    for (const auto& ball : snapshot.balls) {
        const Vec2d to = position_of(ball) - position;
        if (ball.player_id == 0 && (way.isZero() || to.norm() < way.norm())) way = to;
    }
    const auto stats = game::stats_for({});
    const double acceleration = stats.thrust_n / stats.mass_kg;
    const Vec2d direction = way.normalized();
    const Vec2d sideways = velocity - velocity.dot(direction) * direction;
    const Vec2d wanted = (direction - sideways * (2.0 / stats.top_speed_mps)).normalized();
    const double held_s = kDecisionTicks * game::kTickDurationS;
    const Vec2d soon = velocity + wanted * (acceleration * held_s);
    const Vec2d stop = position + velocity * held_s +
                       soon.normalized() * (soon.squaredNorm() / 2.0 / acceleration);
    if (physics::distance_to_edge_m(platform, stop) >= 0.7 || velocity.isZero())
        return game::command_toward(wanted);
    game::InputCommand back = game::command_toward(-velocity.normalized());
    back.brake = true;
    return back;
}

class Beginner : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Beginner, clears_the_first_two_levels_one_of_them_within_a_minute) {
    SCOPED_TRACE("seed " + std::to_string(GetParam()));
    const LoadedLevels loaded = load_levels(FTS_LEVELS_DIR);
    ASSERT_EQ(loaded.error, "");
    MatchBench bench(loaded.levels, GetParam());
    const PlayerId player = bench.join(1);
    for (int level = 1; level <= 2; ++level) {
        bench.tick_until(Phase::kPlaying);
        const auto start = bench.match.totals().ticks;
        const auto& platform = loaded.levels[static_cast<std::size_t>(level - 1)].platform;
        while (bench.match.phase() == Phase::kPlaying) {
            if (bench.match.totals().ticks % kDecisionTicks == 0)
                bench.match.set_input(player,
                                      simple_chase(bench.match.snapshot(), player, platform));
            bench.tick();
        }
        EXPECT_EQ(bench.match.totals().levels_cleared, level);
        EXPECT_LT(bench.match.totals().ticks - start, level == 1 ? 60u * 60u : 60u * 150u);
        bench.match.set_ready(player);
        bench.tick();
    }
    EXPECT_EQ(bench.match.level_number(), 3);
    EXPECT_GE(bench.ledger.coins(key_of(1)), *game::price_coins(0)) << "nothing to shop with";
}
INSTANTIATE_TEST_SUITE_P(Seeds, Beginner, ::testing::Range<std::uint64_t>(1, 9));

}  // namespace
}  // namespace fts::server
