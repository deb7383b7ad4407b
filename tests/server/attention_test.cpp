#include "server/attention.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace fts::server {
namespace {

using replication::BallState;
using replication::Snapshot;

constexpr std::uint16_t kOwner = 7;

std::int32_t steps(double metres) {
    return replication::quantise(metres, replication::kPositionStepM);
}

BallState ball_at(std::uint16_t id, double x_m, double y_m, double vx_mps = 0.0) {
    BallState ball;
    ball.id = id;
    ball.x = steps(x_m);
    ball.y = steps(y_m);
    ball.vx = replication::quantise(vx_mps, replication::kVelocityStepMps);
    ball.radius = static_cast<std::uint16_t>(0.5 / replication::kRadiusStepM);
    return ball;
}

// My ball in the middle of a square of balls a hundred metres wide.
Snapshot field(std::uint16_t balls) {
    Snapshot field;
    field.tick = 1000;
    for (std::uint16_t id = 1; id <= balls; ++id) {
        field.balls.push_back(ball_at(id, (id * 37 % 100) - 50.0, (id * 61 % 100) - 50.0));
    }
    BallState me = ball_at(static_cast<std::uint16_t>(balls + 1), 0.0, 0.0);
    me.player_id = kOwner;
    field.balls.push_back(me);
    return field;
}

TEST(Attention, goes_to_the_own_ball_first_however_often_it_was_told) {
    const Snapshot now = field(300);
    Attention attention;
    attention.told(now.tick, now.balls);
    const auto one = attention.most_wanted(now, kOwner, 1);
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(one[0].player_id, kOwner);
}

TEST(Attention, leaves_nobody_waiting_for_ever) {
    Snapshot now = field(500);
    Attention attention;
    std::vector<replication::Tick> told(now.balls.size() + 1, 0);
    replication::Tick longest_wait = 0;
    for (int i = 0; i < 400; ++i) {
        now.tick += 2;
        const auto balls = attention.most_wanted(now, kOwner, 25);
        ASSERT_EQ(balls.size(), 25U);
        ASSERT_TRUE(std::ranges::is_sorted(balls, {}, &BallState::id));
        attention.told(now.tick, balls);
        for (const BallState& ball : balls) told[ball.id] = now.tick;
        if (i < 200) continue;
        for (const BallState& ball : now.balls) {
            longest_wait = std::max(longest_wait, now.tick - told[ball.id]);
        }
    }
    EXPECT_GT(longest_wait, 2 * 500 / 25) << "what is near is told of more often";
    EXPECT_LT(longest_wait, 2 * 2 * 500 / 25) << "at the cost of the others, within reason";
}

TEST(Attention, is_on_what_is_near_and_more_on_what_comes_closer) {
    Snapshot now = field(300);
    now.balls.insert(now.balls.end() - 1, ball_at(301, 15.0, 0.0, -20.0));  // hits in 0.7 s
    now.balls.insert(now.balls.end() - 1, ball_at(302, 0.0, 4.0));
    now.balls.insert(now.balls.end() - 1, ball_at(303, 15.0, 20.0, -20.0));  // passes by
    now.balls.back().id = 304;
    Attention attention;
    std::vector<int> times(305, 0);
    for (int i = 0; i < 300; ++i) {
        now.tick += 2;
        const auto balls = attention.most_wanted(now, kOwner, 12);
        attention.told(now.tick, balls);
        for (const BallState& ball : balls) ++times[ball.id];
    }
    EXPECT_EQ(times[304], 300) << "the own ball, each time";
    EXPECT_GT(times[301], times[302]);
    EXPECT_GT(times[302], 3 * times[303]);
    EXPECT_GT(times[303], 2);
}

TEST(Attention, of_who_has_no_ball_is_even) {
    Snapshot now = field(99);
    Attention attention;
    std::vector<int> times(101, 0);
    for (int i = 0; i < 100; ++i) {
        now.tick += 2;
        const auto balls = attention.most_wanted(now, 0, 10);
        attention.told(now.tick, balls);
        for (const BallState& ball : balls) ++times[ball.id];
    }
    for (std::size_t id = 1; id <= 100; ++id) EXPECT_EQ(times[id], 10) << id;
}

}  // namespace
}  // namespace fts::server
