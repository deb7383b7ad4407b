// What pilots go by is made of a snapshot once for all bots that hold it.
#include "client/bot/field.h"

#include <gtest/gtest.h>

namespace fts::bot {
namespace {

using physics::Vec2d;
using replication::BallState;
using replication::Snapshot;

BallState ball(std::uint16_t id, std::uint16_t player_id, const Vec2d& position_m) {
    BallState state;
    state.id = id;
    state.player_id = player_id;
    state.kind = player_id == 0 ? 0 : 1;
    state.x = replication::quantise(position_m.x(), replication::kPositionStepM);
    state.y = replication::quantise(position_m.y(), replication::kPositionStepM);
    state.vx = replication::quantise(0.5, replication::kVelocityStepMps);
    state.radius = 2048;
    state.mass = 3 * 65536;
    return state;
}

std::shared_ptr<Snapshot> snapshot(replication::Tick tick, std::uint8_t arena = 0) {
    auto made = std::make_shared<Snapshot>();
    made->tick = tick;
    made->arena = arena;
    made->balls = {ball(1, 0, {6, 0}), ball(2, 7, {0, 3}), ball(5, 0, {0, -11}),
                   ball(9, 8, {1, 1})};
    made->coins = {{4, 65536, -65536, 2}};
    return made;
}

client::Glance glance_of(std::shared_ptr<const Snapshot> newest) {
    client::Glance glance;
    glance.newest = std::move(newest);
    glance.platform = physics::Disc{10.0};
    glance.tick_rate_hz = 60;
    return glance;
}

TEST(Field, has_balls_and_coins_in_metres_and_the_room_that_each_ball_has) {
    const Field field = field_of(*snapshot(90), physics::Disc{10.0}, 60);
    EXPECT_EQ(field.server_time_s, 1.5);
    ASSERT_EQ(field.ai_balls.size(), 2U);
    ASSERT_EQ(field.player_balls.size(), 2U);
    const FieldBall& first = field.ai_balls[0];
    EXPECT_EQ(first.id, 1);
    EXPECT_EQ(first.position_m, Vec2d(6, 0));
    EXPECT_EQ(first.velocity_mps, Vec2d(0.5, 0));
    EXPECT_EQ(first.radius_m, 0.5);
    EXPECT_EQ(first.mass_kg, 3.0);
    EXPECT_NEAR(first.to_edge_m, 4.0, 1e-12);
    EXPECT_NEAR(field.ai_balls[1].to_edge_m, -1.0, 1e-12);
    ASSERT_EQ(field.coins.size(), 1U);
    EXPECT_EQ(field.coins[0].position_m, Vec2d(1, -1));
}

TEST(Field, is_seen_by_each_player_with_the_own_ball) {
    const Field field = field_of(*snapshot(90), physics::Disc{10.0}, 60);
    EXPECT_EQ(sight_of(field, 8, {}, 0.1).own, &field.player_balls[1]);
    EXPECT_EQ(sight_of(field, 3, {}, 0.1).own, nullptr);
    EXPECT_EQ(sight_of(field, 0, {}, 0.1).own, nullptr);
}

TEST(Fields, are_made_once_for_all_who_hold_the_same_snapshot) {
    Fields fields;
    const auto one = snapshot(60), next = snapshot(62), elsewhere = snapshot(60, 3);
    const auto first = fields.of(glance_of(one));
    const auto second = fields.of(glance_of(next));
    const auto third = fields.of(glance_of(elsewhere));
    EXPECT_NE(first, second);
    EXPECT_NE(first, third);
    EXPECT_EQ(fields.of(glance_of(one)), first) << "not all have the newest yet";
    EXPECT_EQ(fields.of(glance_of(next)), second);
    EXPECT_EQ(fields.of(glance_of(elsewhere)), third);
}

TEST(Fields, wait_for_a_snapshot_and_its_level) {
    Fields fields;
    EXPECT_EQ(fields.of(glance_of(nullptr)), nullptr);
    client::Glance glance = glance_of(snapshot(60));
    glance.platform.reset();
    EXPECT_EQ(fields.of(glance), nullptr);
    glance.platform = physics::Ring{2.0, 5.0};
    ASSERT_NE(fields.of(glance), nullptr);
    EXPECT_EQ(std::get<physics::Ring>(fields.of(glance)->platform).outer_radius_m, 5.0);
}

}  // namespace
}  // namespace fts::bot
