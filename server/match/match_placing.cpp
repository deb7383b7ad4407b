// Where balls and coins come from and go to.
#include <algorithm>
#include <cassert>
#include <limits>

#include "server/match/match_impl.h"
#include "server/match/spawn.h"

namespace fts::server {

using physics::Vec2d;
using replication::ArenaChange;
using replication::BallState;
using replication::quantise;

Actor Match::Impl::actor_of(std::uint16_t id, const Ball& ball) {
    return ball.player != 0 ? Actor{ball.player, 0} : Actor{0, id};
}

void Match::Impl::earn(PlayerId id, int earned) {
    score(id).coins_earned += earned;
    players.at(id).coins_this_level += earned;
}

void Match::Impl::spawn_due() {
    if (phase != game::Phase::kCountdown && phase != game::Phase::kPlaying) return;
    bool delayed = false;
    if (ai_tried_in != now) ai_tried = 0;
    ai_tried_in = now;
    std::erase_if(waiting_ai, [&](const Waiting& waiting) {
        if (ai_tried == kMaxAiPlacedInTick) return false;
        ++ai_tried;
        const bool placed = spawn_ai(waiting);
        delayed |= !placed;
        return placed;
    });
    for (auto& [id, player] : players) {
        if (player.ball != 0 || player.lives == 0 || now < player.spawn_tick) continue;
        delayed |= !spawn_player(id, player);
    }
    if (delayed) ++totals.spawns_delayed;
}

bool Match::Impl::spawn_ai(const Waiting& waiting) {
    const game::AiGroup& group = level().ai[waiting.group];
    Ball ball;
    ball.stats = game::stats_for({});
    ball.stats.radius_m = group.radius_m;
    ball.stats.mass_kg = group.mass_kg;
    ball.stats.thrust_n = group.thrust_n;
    ball.stats.top_speed_mps = group.top_speed_mps;
    ball.behaviour = group.behaviour;
    ball.pilot.emplace(group.behaviour, group.difficulty, waiting.seed);
    return place_ball(std::move(ball)).has_value();
}

bool Match::Impl::spawn_player(PlayerId id, Player& player) {
    Ball ball;
    ball.player = id;
    ball.stats = game::stats_for(ledger.tiers(player.key));
    const auto placed = place_ball(std::move(ball));
    if (!placed) return false;
    player.ball = *placed;
    attribution.respawned({id, 0});
    return true;
}

std::optional<std::uint16_t> Match::Impl::place_ball(Ball ball) {
    struct Disc {
        Vec2d centre_m;
        double radius_m = 0.0;
    };
    std::vector<Disc> taken;
    taken.reserve(balls.size());
    for (const auto& [id, other] : balls) {
        const auto there = body(id);
        taken.push_back({there.position_m, there.radius_m});
    }
    const auto clearance_m = [&taken](const Vec2d& point) {
        double nearest_m = std::numeric_limits<double>::infinity();
        for (const Disc& disc : taken) {
            nearest_m = std::min(nearest_m, (disc.centre_m - point).norm() - disc.radius_m);
        }
        return nearest_m;
    };
    settle_on_lattice(ball.stats);
    const auto spot = find_spawn(level().platform, ball.stats.radius_m, clearance_m, random);
    if (!spot) return std::nullopt;
    const auto id = ball_ids.take(now);
    if (!id) return std::nullopt;
    const BallState state = state_of(*id, ball, *spot);
    if (!arena->put(state)) {
        ball_ids.give_back(*id, now);
        return std::nullopt;
    }
    log.add(ArenaChange::ball_put(event_tick(), state));
    balls.emplace(*id, std::move(ball));
    return id;
}

void Match::Impl::settle_on_lattice(game::BallStats& stats) {
    const auto rounded = [](double value, double step) {
        return replication::dequantise(quantise(value, step), step);
    };
    stats.radius_m = rounded(stats.radius_m, replication::kRadiusStepM);
    stats.mass_kg = rounded(stats.mass_kg, replication::kMassStepKg);
}

// At rest, with nobody steering.
BallState Match::Impl::state_of(std::uint16_t id, const Ball& ball, const Vec2d& position_m) const {
    const bool is_player = ball.player != 0;
    return {
        .id = id,
        .x = quantise(position_m.x(), replication::kPositionStepM),
        .y = quantise(position_m.y(), replication::kPositionStepM),
        .radius =
            static_cast<std::uint16_t>(quantise(ball.stats.radius_m, replication::kRadiusStepM)),
        .mass = static_cast<std::uint32_t>(quantise(ball.stats.mass_kg, replication::kMassStepKg)),
        .kind = static_cast<std::uint8_t>(is_player ? replication::BallKind::kPlayer
                                                    : replication::BallKind::kAi),
        .behaviour =
            static_cast<std::uint8_t>(is_player ? game::Behaviour::kChaser : ball.behaviour),
        .player_id = ball.player,
        .handling = replication::quantised(game::handling_of(ball.stats))};
}

void Match::Impl::remove_ball(std::uint16_t id) {
    const auto found = balls.find(id);
    assert(found != balls.end());
    if (arena->slot_of(id)) {
        arena->remove(id);
        log.add(ArenaChange::ball_gone(event_tick(), id));
    }
    balls.erase(found);
    ball_ids.give_back(id, now);
}

bool Match::Impl::put_coin(const Vec2d& position_m) {
    if (coins.size() == kMaxFieldCoins) return false;
    const auto id = coin_ids.take(now);
    if (!id) return false;
    const Coin coin{position_m};
    coins.emplace(*id, coin);
    log.add(ArenaChange::coin_put(event_tick(), state_of(*id, coin)));
    return true;
}

replication::CoinState Match::Impl::state_of(std::uint16_t id, const Coin& coin) const {
    return {id, quantise(coin.position_m.x(), replication::kPositionStepM),
            quantise(coin.position_m.y(), replication::kPositionStepM),
            static_cast<std::uint16_t>(coin.value_coins)};
}

void Match::Impl::forget_coin(std::uint16_t id) {
    coin_ids.give_back(id, now);
    log.add(ArenaChange::coin_gone(event_tick(), id));
}

void Match::Impl::drop_coins(PlayerId id, const Vec2d& fallen_at_m) {
    constexpr std::int64_t kDropDivisor = 10;
    constexpr std::int64_t kMostDropped = 5;
    constexpr double kDropSpreadM = 2.0;
    constexpr double kDropMarginM = 0.5;
    const PlayerKey& key = players.at(id).key;
    const std::int64_t dropped = std::min(ledger.coins(key) / kDropDivisor, kMostDropped);
    const Vec2d edge = physics::nearest_edge_point_m(level().platform, fallen_at_m);
    for (std::int64_t i = 0; i < dropped; ++i) {
        if (!put_coin(scatter_near(level().platform, edge, kDropSpreadM, kDropMarginM, random))) {
            totals.drops_refused += static_cast<std::uint64_t>(dropped - i);
            return;
        }
        ledger.drop(key, config.arena, 1);
        ++score(id).coins_dropped;
    }
}

void Match::Impl::clear_field() {
    for (const auto& [id, coin] : coins) forget_coin(id);
    coins.clear();
    ledger.sweep_field(config.arena);
}

}  // namespace fts::server
