#include "tests/server/match/match_bench.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace fts::server {

PlayerKey key_of(int number) {
    PlayerKey key{};
    key[0] = static_cast<std::uint8_t>(number);
    key[1] = static_cast<std::uint8_t>(number >> 8);
    return key;
}

std::uint64_t hash_of(const replication::Snapshot& snapshot) {
    std::uint64_t hash = 14695981039346656037u;
    const auto mix = [&hash](auto... values) {
        ((hash = (hash ^ static_cast<std::uint64_t>(values)) * 1099511628211u), ...);
    };
    mix(snapshot.tick, snapshot.phase, snapshot.level, snapshot.phase_end_tick);
    for (const auto& ball : snapshot.balls)
        mix(ball.id, ball.x, ball.y, ball.vx, ball.vy, ball.thrust_x, ball.thrust_y, ball.brake,
            ball.radius, ball.mass, ball.kind, ball.behaviour, ball.player_id);
    for (const auto& coin : snapshot.coins) mix(coin.id, coin.x, coin.y, coin.value_coins);
    for (const auto& hit : snapshot.hits) mix(hit.tick, hit.a, hit.b, hit.x, hit.y, hit.impulse);
    return hash;
}

game::Level quiet_level(int number, const physics::Platform& platform, int ai_balls) {
    game::Level level;
    level.number = number;
    level.name = "Quiet";
    level.hint = "Nobody moves but you.";
    level.platform = platform;
    level.ai = {{.count = ai_balls, .thrust_n = 0.0}};
    return level;
}

MatchBench::MatchBench(std::vector<game::Level> levels, std::uint64_t seed, int max_players)
    : match({.arena = 0,
             .seed = seed,
             .levels = std::move(levels),
             .max_players = max_players,
             .solvers = {}},
            ledger) {}

PlayerId MatchBench::join(int number, std::int64_t coins) {
    const PlayerKey key = key_of(number);
    if (!ledger.is_loaded(key)) {
        PlayerRecord record;
        record.key = key;
        ledger.load(record);
        if (coins > 0) ledger.award(key, static_cast<int>(coins), Reason::kLevelClear);
    }
    const auto player = match.join(key, "player " + std::to_string(number));
    EXPECT_TRUE(player.has_value());
    return player.value_or(PlayerId{0});
}

void MatchBench::tick(int count) {
    said_.clear();
    for (int i = 0; i < count; ++i) {
        match.tick();
        for (Outgoing& outgoing : match.drain_outgoing()) said_.push_back(std::move(outgoing));
    }
}

void MatchBench::tick_until(game::Phase phase, int limit) {
    std::vector<Outgoing> all;
    for (int i = 0; i < limit && match.phase() != phase; ++i) {
        tick();
        all.insert(all.end(), said_.begin(), said_.end());
    }
    EXPECT_EQ(match.phase(), phase);
    said_ = std::move(all);
}

std::optional<replication::BallState> MatchBench::ball_of(PlayerId player) const {
    for (const auto& ball : match.snapshot().balls)
        if (ball.player_id == player) return ball;
    return std::nullopt;
}

ScoreLine MatchBench::score_of(PlayerId player) const {
    for (const ScoreLine& line : match.scoreboard())
        if (line.player == player) return line;
    return {};
}

game::InputCommand ram(const replication::Snapshot& snapshot, PlayerId player, Prey prey) {
    const auto own = std::find_if(snapshot.balls.begin(), snapshot.balls.end(),
                                  [player](const auto& ball) { return ball.player_id == player; });
    if (own == snapshot.balls.end()) return {};
    physics::Vec2d nearest = physics::Vec2d::Zero();
    for (const auto& ball : snapshot.balls) {
        if (ball.id == own->id || (prey == Prey::kAi && ball.player_id != 0)) continue;
        const physics::Vec2d way = position_of(ball) - position_of(*own);
        if (nearest.isZero() || way.norm() < nearest.norm()) nearest = way;
    }
    const physics::Vec2d direction = nearest.normalized();
    const physics::Vec2d sideways =
        velocity_of(*own) - velocity_of(*own).dot(direction) * direction;
    return game::command_toward((direction - sideways * 0.4).normalized());
}

}  // namespace fts::server
