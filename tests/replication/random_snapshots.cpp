#include "tests/replication/random_snapshots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "common/game/rules.h"
#include "common/replication/delta.h"

namespace fts::replication::testing {
namespace {

std::int32_t any_steps(Rng& rng) {
    using Limits = std::numeric_limits<std::int32_t>;
    switch (pick(rng, 0, 5)) {
        case 0:
            return static_cast<std::int32_t>(pick(rng, -4, 4));
        case 1:
            return static_cast<std::int32_t>(pick(rng, Limits::min(), Limits::max()));
        case 2:
            return chance(rng, 50) ? Limits::min() : Limits::max();
        default:
            return static_cast<std::int32_t>(pick(rng, -20'000, 20'000));
    }
}

template <typename Unsigned>
Unsigned any_unsigned(Rng& rng) {
    constexpr Unsigned kGreatest = std::numeric_limits<Unsigned>::max();
    if (chance(rng, 20)) return kGreatest;
    return static_cast<Unsigned>(pick(rng, 0, chance(rng, 50) ? 99 : kGreatest));
}

void change_some(Rng& rng, BallState& ball) {
    if (chance(rng, 40)) std::tie(ball.x, ball.y) = std::tuple(any_steps(rng), any_steps(rng));
    if (chance(rng, 40)) std::tie(ball.vx, ball.vy) = std::tuple(any_steps(rng), any_steps(rng));
    if (chance(rng, 30)) ball.thrust_x = static_cast<std::int8_t>(pick(rng, -128, 127));
    if (chance(rng, 30)) ball.thrust_y = static_cast<std::int8_t>(pick(rng, -128, 127));
    if (chance(rng, 20)) ball.brake = !ball.brake;
    if (chance(rng, 10)) ball.radius = any_unsigned<std::uint16_t>(rng);
    if (chance(rng, 10)) ball.mass = any_unsigned<std::uint32_t>(rng);
    if (chance(rng, 10)) ball.kind = static_cast<std::uint8_t>(pick(rng, 0, 1));
    if (chance(rng, 10)) {
        ball.behaviour = static_cast<std::uint8_t>(pick(rng, 0, static_cast<int>(kLastBehaviour)));
    }
    if (chance(rng, 10)) ball.player_id = any_unsigned<std::uint16_t>(rng);
    if (chance(rng, 10)) {
        ball.handling = {any_unsigned<std::uint32_t>(rng), any_unsigned<std::uint32_t>(rng),
                         any_unsigned<std::uint32_t>(rng), any_unsigned<std::uint32_t>(rng)};
    }
}

void change_some(Rng& rng, CoinState& coin) {
    if (chance(rng, 30)) std::tie(coin.x, coin.y) = std::tuple(any_steps(rng), any_steps(rng));
    if (chance(rng, 20)) coin.value_coins = any_unsigned<std::uint16_t>(rng);
}

template <typename Entry>
void add_some(Rng& rng, std::vector<Entry>& entries, std::size_t at_most) {
    std::set<std::uint16_t> taken;
    for (const Entry& entry : entries) taken.insert(entry.id);
    const auto count = pick(rng, 0, static_cast<std::int64_t>(at_most));
    const bool dense = chance(rng, 50);
    for (std::int64_t i = 0; i < count; ++i) {
        Entry entry;
        entry.id = static_cast<std::uint16_t>(pick(rng, 0, dense ? 300 : 0xFFFF));
        if (!taken.insert(entry.id).second) continue;
        change_some(rng, entry);
        entries.push_back(entry);
    }
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.id < b.id; });
}

void add_hits(Rng& rng, Snapshot& snapshot) {
    const auto count = pick(rng, 0, chance(rng, 10) ? 300 : 8);
    for (std::int64_t i = 0; i < count; ++i) {
        HitState hit;
        hit.tick = chance(rng, 80) ? snapshot.tick - static_cast<Tick>(pick(rng, 0, 1))
                                   : any_unsigned<Tick>(rng);
        hit.a = any_unsigned<std::uint16_t>(rng);
        hit.b = any_unsigned<std::uint16_t>(rng);
        std::tie(hit.x, hit.y) = std::tuple(any_steps(rng), any_steps(rng));
        hit.impulse = any_unsigned<std::uint32_t>(rng);
        snapshot.hits.push_back(hit);
    }
    std::stable_sort(snapshot.hits.begin(), snapshot.hits.end(),
                     [](const HitState& a, const HitState& b) {
                         return std::tie(a.tick, a.a, a.b) < std::tie(b.tick, b.a, b.b);
                     });
}

void set_arena_state(Rng& rng, Snapshot& snapshot) {
    snapshot.phase = static_cast<game::Phase>(pick(rng, 0, 3));
    if (chance(rng, 30)) snapshot.level = any_unsigned<std::uint16_t>(rng);
    if (chance(rng, 30)) snapshot.phase_end_tick = any_unsigned<Tick>(rng);
}

}  // namespace

Snapshot wild_snapshot(Rng& rng, Tick tick, std::size_t max_balls) {
    Snapshot snapshot;
    snapshot.tick = tick;
    snapshot.arena = any_unsigned<std::uint8_t>(rng);
    set_arena_state(rng, snapshot);
    add_some(rng, snapshot.balls, max_balls);
    add_some(rng, snapshot.coins, max_balls / 2);
    add_hits(rng, snapshot);
    return snapshot;
}

Snapshot wild_successor(Rng& rng, const Snapshot& before, Tick tick) {
    Snapshot snapshot = before;
    snapshot.tick = tick;
    snapshot.hits.clear();
    set_arena_state(rng, snapshot);
    const int gone = static_cast<int>(pick(rng, 0, 60));
    const int changed = static_cast<int>(pick(rng, 0, 100));
    std::erase_if(snapshot.balls, [&](const BallState&) { return chance(rng, gone); });
    std::erase_if(snapshot.coins, [&](const CoinState&) { return chance(rng, gone); });
    for (BallState& ball : snapshot.balls) {
        if (chance(rng, changed)) change_some(rng, ball);
    }
    for (CoinState& coin : snapshot.coins) {
        if (chance(rng, changed)) change_some(rng, coin);
    }
    add_some(rng, snapshot.balls, before.balls.size() / 2 + 3);
    add_some(rng, snapshot.coins, before.coins.size() / 2 + 3);
    add_hits(rng, snapshot);
    return snapshot;
}

SnapshotPair wild_pair(Rng& rng, std::size_t max_balls) {
    const auto tick = static_cast<Tick>(pick(rng, 1, 100'000));
    const Snapshot before = wild_snapshot(rng, tick, max_balls);
    const auto age_ticks = static_cast<Tick>(pick(rng, 1, kMaxBaselineAgeTicks));
    return {before, wild_successor(rng, before, tick + age_ticks)};
}

namespace {

constexpr double kPlatformRadiusM = 12.0;
constexpr double kThrustMps2 = 6.0;
constexpr double kTopSpeedMps = 5.0;

double uniform(Rng& rng, double low, double high) {
    return low + (high - low) * static_cast<double>(rng() >> 11) * 0x1.0p-53;
}

}  // namespace

MovingScene::MovingScene(std::uint64_t seed, std::size_t ball_count, Drive drive)
    : rng_(seed), drive_(drive) {
    for (std::size_t i = 0; i < ball_count; ++i) {
        const double angle = uniform(rng_, 0, 6.28), distance_m = uniform(rng_, 0, 11);
        Ball ball{.x_m = distance_m * std::cos(angle),
                  .y_m = distance_m * std::sin(angle),
                  .vx_mps = uniform(rng_, -4, 4),
                  .vy_mps = uniform(rng_, -4, 4),
                  .thrust_x = 0,
                  .thrust_y = 0,
                  .radius_m = uniform(rng_, 0.3, 0.7),
                  .mass_kg = uniform(rng_, 0.5, 3)};
        if (drive_ == Drive::kSteered) steer(ball);
        balls_.push_back(ball);
    }
}

void MovingScene::steer(Ball& ball) {
    const double angle = uniform(rng_, 0, 6.28);
    ball.thrust_x = static_cast<std::int8_t>(std::lround(127 * std::cos(angle)));
    ball.thrust_y = static_cast<std::int8_t>(std::lround(127 * std::sin(angle)));
}

void MovingScene::tick() {
    constexpr double kTickS = game::kTickDurationS;
    for (Ball& ball : balls_) {
        if (drive_ == Drive::kSteered) {
            if (chance(rng_, 7)) steer(ball);  // decides about every 250 ms
            const double drag_per_s = kThrustMps2 / kTopSpeedMps;
            ball.vx_mps += (kThrustMps2 * ball.thrust_x / 127 - drag_per_s * ball.vx_mps) * kTickS;
            ball.vy_mps += (kThrustMps2 * ball.thrust_y / 127 - drag_per_s * ball.vy_mps) * kTickS;
        }
        ball.x_m += ball.vx_mps * kTickS;
        ball.y_m += ball.vy_mps * kTickS;
        const double distance_m = std::hypot(ball.x_m, ball.y_m);
        const double nx = ball.x_m / distance_m, ny = ball.y_m / distance_m;
        const double outward_mps = ball.vx_mps * nx + ball.vy_mps * ny;
        if (drive_ == Drive::kSteered && distance_m > kPlatformRadiusM && outward_mps > 0) {
            ball.vx_mps -= 2 * outward_mps * nx;
            ball.vy_mps -= 2 * outward_mps * ny;
        }
    }
    if (drive_ == Drive::kSteered) collide();
}

void MovingScene::collide() {
    for (std::size_t i = 0; i < balls_.size(); ++i) {
        for (std::size_t j = i + 1; j < balls_.size(); ++j) {
            Ball &a = balls_[i], &b = balls_[j];
            const double dx = a.x_m - b.x_m, dy = a.y_m - b.y_m, distance_m = std::hypot(dx, dy);
            const double nx = dx / distance_m, ny = dy / distance_m;
            const double closing = (a.vx_mps - b.vx_mps) * nx + (a.vy_mps - b.vy_mps) * ny;
            if (distance_m > a.radius_m + b.radius_m || closing >= 0) continue;
            const double impulse = -2 * closing / (1 / a.mass_kg + 1 / b.mass_kg);
            a.vx_mps += impulse / a.mass_kg * nx;
            a.vy_mps += impulse / a.mass_kg * ny;
            b.vx_mps -= impulse / b.mass_kg * nx;
            b.vy_mps -= impulse / b.mass_kg * ny;
        }
    }
}

Snapshot MovingScene::snapshot(Tick tick) const {
    Snapshot snapshot;
    snapshot.tick = tick;
    snapshot.phase = game::Phase::kPlaying;
    snapshot.level = 3;
    snapshot.phase_end_tick = 9000;
    for (const Ball& ball : balls_) {
        BallState state;
        state.id = static_cast<std::uint16_t>(snapshot.balls.size() + 1);
        state.x = quantise(ball.x_m, kPositionStepM);
        state.y = quantise(ball.y_m, kPositionStepM);
        state.vx = quantise(ball.vx_mps, kVelocityStepMps);
        state.vy = quantise(ball.vy_mps, kVelocityStepMps);
        state.thrust_x = ball.thrust_x;
        state.thrust_y = ball.thrust_y;
        state.radius = static_cast<std::uint16_t>(quantise(ball.radius_m, kRadiusStepM));
        state.mass = static_cast<std::uint32_t>(quantise(ball.mass_kg, kMassStepKg));
        snapshot.balls.push_back(state);
    }
    return snapshot;
}

}  // namespace fts::replication::testing
