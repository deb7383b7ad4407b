// Where balls are drawn between two snapshots.
#include "client/core/interpolation.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace fts::client {
namespace {

using physics::Vec2d;
using replication::BallState;
using replication::Snapshot;

constexpr int kRateHz = 60;

BallState ball(std::uint16_t id, double x_m, double y_m, double vx_mps, double vy_mps) {
    BallState state;
    state.id = id;
    state.x = replication::quantise(x_m, replication::kPositionStepM);
    state.y = replication::quantise(y_m, replication::kPositionStepM);
    state.vx = replication::quantise(vx_mps, replication::kVelocityStepMps);
    state.vy = replication::quantise(vy_mps, replication::kVelocityStepMps);
    return state;
}

Snapshot at(replication::Tick tick, std::vector<BallState> balls) {
    Snapshot snapshot;
    snapshot.tick = tick;
    snapshot.balls = std::move(balls);
    return snapshot;
}

TEST(Interpolation, is_exact_for_a_ball_in_straight_flight) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> steps(-2000, 2000);
    for (int i = 0; i < 200; ++i) {
        // 15 velocity steps are 4 position steps in 4 ticks: nothing is rounded.
        const int vx = steps(random), vy = steps(random);
        BallState first;
        first.id = 1;
        first.x = steps(random);
        first.y = steps(random);
        first.vx = 15 * vx;
        first.vy = 15 * vy;
        BallState second = first;
        second.x += 4 * vx;
        second.y += 4 * vy;
        const Vec2d start_m(first.x / 65536.0, first.y / 65536.0);
        const Vec2d velocity_mps(first.vx / 16384.0, first.vy / 16384.0);
        for (const double ticks : {0.0, 0.1, 2.0, 3.7, 4.0, 5.0}) {
            const auto poses =
                interpolate(at(100, {first}), at(104, {second}), 100 + ticks, kRateHz);
            ASSERT_EQ(poses.size(), 1U);
            const Vec2d expected_m = start_m + velocity_mps * ticks / kRateHz;
            EXPECT_LT((poses[0].position_m - expected_m).norm(), 1e-12);
            EXPECT_LT((poses[0].velocity_mps - velocity_mps).norm(), 1e-12);
        }
    }
}

TEST(Interpolation, coasts_beyond_the_newest_snapshot_but_not_for_ever) {
    const Snapshot newest = at(60, {ball(1, 2, 0, 3, -1.5)});
    const auto soon = interpolate(newest, newest, 63, kRateHz);
    EXPECT_LT((soon[0].position_m - Vec2d(2.15, -0.075)).norm(), 1e-12);
    const auto limit = interpolate(newest, newest, 60 + kMaxExtrapolationS * kRateHz, kRateHz);
    const auto late = interpolate(newest, newest, 600, kRateHz);
    EXPECT_EQ(late[0].position_m, limit[0].position_m);
}

TEST(Interpolation, draws_no_slide_to_a_place_that_cannot_be_flown_to) {
    const Snapshot from = at(10, {ball(1, 9, 0, 2, 0)});
    const Snapshot to = at(12, {ball(1, -3, 0, 0, 0)});
    for (const double tick : {10.5, 11.0, 11.9}) {
        EXPECT_EQ(interpolate(from, to, tick, kRateHz)[0].position_m, Vec2d(9, 0));
    }
    EXPECT_EQ(interpolate(from, to, 12.0, kRateHz)[0].position_m, Vec2d(-3, 0));
}

TEST(Interpolation, follows_a_fast_ball_that_is_no_teleport) {
    const double speed_mps = 60.0;
    const Snapshot from = at(10, {ball(1, 0, 0, speed_mps, 0)});
    const Snapshot to = at(14, {ball(1, 4, 0, speed_mps, 0)});
    EXPECT_LT((interpolate(from, to, 12, kRateHz)[0].position_m - Vec2d(2, 0)).norm(), 1e-12);
}

TEST(Interpolation, lets_a_ball_that_is_gone_coast_until_then) {
    const Snapshot from = at(10, {ball(1, 0, 0, 1, 0), ball(2, 5, 0, 6, 0), ball(3, 1, 1, 0, 0)});
    const Snapshot to = at(12, {ball(1, 0, 0, 1, 0), ball(3, 1, 1, 0, 0)});
    const auto between = interpolate(from, to, 11, kRateHz);
    ASSERT_EQ(between.size(), 3U);
    EXPECT_LT((between[1].position_m - Vec2d(5.1, 0)).norm(), 1e-12);
    EXPECT_EQ(interpolate(from, to, 12, kRateHz).size(), 2U);
}

TEST(Interpolation, shows_a_new_ball_from_its_first_snapshot_on) {
    const Snapshot from = at(10, {ball(5, 0, 0, 0, 0)});
    const Snapshot to = at(12, {ball(2, 3, 3, 1, 0), ball(5, 0, 0, 0, 0)});
    EXPECT_EQ(interpolate(from, to, 11.9, kRateHz).size(), 1U);
    const auto there = interpolate(from, to, 12, kRateHz);
    ASSERT_EQ(there.size(), 2U);
    EXPECT_EQ(there[0].state->id, 2);
    EXPECT_EQ(there[0].position_m, Vec2d(3, 3));
}

TEST(Interpolation, stays_sorted_by_id_whoever_comes_and_goes) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        std::bernoulli_distribution is_there(0.6);
        Snapshot from = at(10, {}), to = at(12, {});
        for (std::uint16_t id = 1; id < 40; ++id) {
            if (is_there(random)) from.balls.push_back(ball(id, id, 0, 0, 0));
            if (is_there(random)) to.balls.push_back(ball(id, id, 0.1, 0, 0));
        }
        const auto poses = interpolate(from, to, 11, kRateHz);
        ASSERT_EQ(poses.size(), from.balls.size());
        for (std::size_t i = 0; i < poses.size(); ++i) {
            EXPECT_EQ(poses[i].state->id, from.balls[i].id);
            EXPECT_EQ(poses[i].position_m.x(), from.balls[i].id);
        }
    }
}

BallState heavy_ball(std::uint16_t id, double x_m, double y_m, double vx_mps, double vy_mps) {
    BallState state = ball(id, x_m, y_m, vx_mps, vy_mps);
    state.radius = 2048;
    state.mass = 65536;
    return state;
}

TEST(FlightInterpolation, draws_a_hit_between_snapshots_where_it_happened) {
    const Snapshot from = at(10, {heavy_ball(1, -0.65, 0, 8, 0), heavy_ball(2, 0.65, 0, -8, 0)});
    const Snapshot to = at(13, {heavy_ball(1, -0.75, 0, -8, 0), heavy_ball(2, 0.75, 0, 8, 0)});
    FlightInterpolation flights(replication::Course{});
    const double hit_tick = 10 + 0.3 / 16.0 * kRateHz;
    const auto poses = flights.at(from, to, {}, hit_tick);
    ASSERT_EQ(poses.size(), 2U);
    EXPECT_EQ(poses[0].state, &from.balls[0]);
    EXPECT_NEAR(poses[0].position_m.x(), -0.5, replication::kPositionStepM);
    EXPECT_NEAR(poses[1].position_m.x(), 0.5, replication::kPositionStepM);
    // Straight lines are 7 cm short of it.
    EXPECT_GT(std::abs(interpolate(from, to, hit_tick, kRateHz)[0].position_m.x() + 0.5), 0.07);
}

TEST(FlightInterpolation, goes_from_snapshot_to_snapshot_and_on_beyond_the_newest) {
    const Snapshot first = at(10, {heavy_ball(1, 0, 0, 6, 0)});
    const Snapshot second = at(12, {heavy_ball(1, 0.2, 0, 6, 0), heavy_ball(2, 3, 3, 0, 0)});
    const Snapshot third = at(14, {heavy_ball(1, 0.4, 0, 6, 0), heavy_ball(2, 3, 3, 0, 0)});
    FlightInterpolation flights(replication::Course{});
    const auto x_at = [&](const Snapshot& from, const Snapshot& to, double tick) {
        return flights.at(from, to, {}, tick).front().position_m.x();
    };
    for (double tick = 10.0; tick <= 26.0; tick += 0.25) {
        const Snapshot& from = tick < 12.0 ? first : tick < 14.0 ? second : third;
        const Snapshot& to = tick < 12.0 ? second : third;
        const double shown = std::min(tick, 14.0 + kMaxExtrapolationS * kRateHz);
        EXPECT_NEAR(x_at(from, to, tick), (shown - 10.0) * 0.1, replication::kPositionStepM);
    }
    EXPECT_EQ(x_at(first, second, 9.0), 0.0);
    EXPECT_EQ(flights.at(first, second, {}, 11.9).size(), 1U);
    EXPECT_EQ(flights.at(first, second, {}, 12.0).size(), 2U);
}

}  // namespace
}  // namespace fts::client
