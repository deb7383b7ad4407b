// A scripted player with base stats against the shipped levels: what a beginner can expect.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

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

// Seconds that each of the first levels took; shorter when one was not cleared.
std::vector<double> times_to_clear_s(const std::vector<game::Level>& levels, int count,
                                     std::uint64_t seed) {
    MatchBench bench(levels, seed);
    const PlayerId player = bench.join(1);
    std::vector<double> times_s;
    for (int level = 1; level <= count; ++level) {
        bench.tick_until(Phase::kPlaying);
        const auto start = bench.match.totals().ticks;
        const auto& platform = levels[static_cast<std::size_t>(level - 1)].platform;
        while (bench.match.phase() == Phase::kPlaying) {
            if (bench.match.totals().ticks % kDecisionTicks == 0)
                bench.match.set_input(player,
                                      simple_chase(bench.match.snapshot(), player, platform));
            bench.tick();
        }
        if (bench.match.totals().levels_cleared < level) return times_s;
        times_s.push_back(static_cast<double>(bench.match.totals().ticks - start) *
                          game::kTickDurationS);
        bench.match.set_ready(player);
        bench.tick();
    }
    EXPECT_GE(bench.ledger.coins(key_of(1)), *game::price_coins(0)) << "nothing to shop with";
    return times_s;
}

TEST(Beginner, clears_the_first_two_levels_and_typically_the_first_within_a_minute) {
    const LoadedLevels loaded = load_levels(FTS_LEVELS_DIR);
    ASSERT_EQ(loaded.error, "");
    std::vector<double> first_level_s;
    int second_levels = 0;
    for (std::uint64_t seed = 1; seed <= 15; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto times_s = times_to_clear_s(loaded.levels, 2, seed);
        second_levels += times_s.size() == 2;
        first_level_s.push_back(times_s.empty() ? std::numeric_limits<double>::infinity()
                                                : times_s[0]);
    }
    std::sort(first_level_s.begin(), first_level_s.end());
    EXPECT_LT(first_level_s[first_level_s.size() / 2], 60.0);
    EXPECT_TRUE(std::isfinite(first_level_s[13])) << "14 of 15 clear the first level";
    EXPECT_GE(second_levels, 12) << "of 15";
}

}  // namespace
}  // namespace fts::server
