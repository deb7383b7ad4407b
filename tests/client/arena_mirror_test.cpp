// What a client shows of its arena.
#include "client/core/arena_mirror.h"

#include <gtest/gtest.h>

namespace fts::client {
namespace {

using physics::Vec2d;
using replication::Snapshot;

std::shared_ptr<Snapshot> snapshot(replication::Tick tick, double x_m = 0.0) {
    auto result = std::make_shared<Snapshot>();
    result->tick = tick;
    result->phase = game::Phase::kPlaying;
    result->level = 1;
    replication::BallState ball;
    ball.id = 4;
    ball.x = replication::quantise(x_m, replication::kPositionStepM);
    ball.vx = replication::quantise(6.0, replication::kVelocityStepMps);
    ball.kind = static_cast<std::uint8_t>(replication::BallKind::kPlayer);
    ball.player_id = 9;
    result->balls.push_back(ball);
    return result;
}

replication::Welcome welcome() {
    return {9, 0, 60, 30, "test"};
}

TEST(ArenaMirror, shows_an_empty_arena_before_the_first_snapshot) {
    ArenaMirror mirror;
    mirror.apply(welcome());
    const View view = mirror.view_at(0.0);
    EXPECT_TRUE(view.balls.empty());
    EXPECT_FALSE(view.own_ball);
    EXPECT_EQ(view.own_player_id, 9);
    EXPECT_EQ(view.own_player(), nullptr);
}

TEST(ArenaMirror, draws_straight_through_snapshots_that_are_missing) {
    ArenaMirror mirror;
    mirror.apply(welcome());
    mirror.add(snapshot(60, 0.0));
    mirror.add(snapshot(62, 0.2));
    mirror.add(snapshot(70, 1.0));  // 64, 66 and 68 never came
    mirror.add(snapshot(72, 1.2));
    for (double tick = 60.0; tick <= 72.0; tick += 0.37) {
        const View view = mirror.view_at(tick / 60.0);
        ASSERT_TRUE(view.own_ball);
        // A position is known to half a step of the lattice.
        EXPECT_NEAR(view.balls[*view.own_ball].position_m.x(), (tick - 60.0) * 0.1,
                    replication::kPositionStepM);
    }
}

TEST(ArenaMirror, shows_each_hit_once_when_its_moment_is_drawn) {
    ArenaMirror mirror;
    mirror.add(snapshot(60));
    auto with_hits = snapshot(62);
    with_hits->hits = {{61, 1, 2, 65536, 0, 512}, {62, 3, 4, 0, 131072, 256}};
    mirror.add(with_hits);
    EXPECT_TRUE(mirror.view_at(60.5 / 60.0).hits.empty());
    const View first = mirror.view_at(61.5 / 60.0);
    ASSERT_EQ(first.hits.size(), 1U);
    EXPECT_EQ(first.hits[0].point_m, Vec2d(1, 0));
    EXPECT_DOUBLE_EQ(first.hits[0].impulse_ns, 2.0);
    EXPECT_EQ(mirror.view_at(62.5 / 60.0).hits.size(), 1U);
    EXPECT_TRUE(mirror.view_at(63.0 / 60.0).hits.empty());
}

TEST(ArenaMirror, keeps_the_platform_of_the_level_that_is_drawn) {
    ArenaMirror mirror;
    replication::LevelStarted first, second;
    first.number = 1;
    first.platform = physics::Disc{10.0};
    second.number = 2;
    second.platform = physics::Disc{6.0};
    mirror.apply(first);
    mirror.add(snapshot(60));
    auto next = snapshot(62);
    next->level = 2;
    mirror.add(next);
    mirror.apply(second);  // arrives while level 1 is still drawn
    EXPECT_EQ(mirror.view_at(61.0 / 60.0).level.number, 1);
    const View later = mirror.view_at(62.0 / 60.0);
    EXPECT_EQ(later.level.number, 2);
    EXPECT_EQ(std::get<physics::Disc>(later.level.platform).radius_m, 6.0);
}

std::shared_ptr<Snapshot> two_balls(replication::Tick tick, double x_m, double vx_mps) {
    auto result = snapshot(tick, -x_m);
    result->balls[0].vx = replication::quantise(vx_mps, replication::kVelocityStepMps);
    result->balls[0].radius = 2048;
    result->balls[0].mass = 65536;
    result->balls.push_back(result->balls[0]);
    replication::BallState& other = result->balls[1];
    other.id = 5;
    other.x = -other.x;
    other.vx = -other.vx;
    return result;
}

TEST(ArenaMirror, draws_hits_between_snapshots_once_it_knows_the_level_that_is_shown) {
    for (const bool knows_the_level : {true, false}) {
        ArenaMirror mirror;
        mirror.apply(welcome());
        replication::LevelStarted level;
        level.number = 1;
        level.platform = physics::Disc{10.0};
        if (knows_the_level) mirror.apply(level);
        mirror.add(two_balls(60, 0.65, 8.0));
        mirror.add(two_balls(63, 0.75, -8.0));
        const View view = mirror.view_at((60.0 + 0.3 / 16.0 * 60.0) / 60.0);
        ASSERT_EQ(view.balls.size(), 2U);
        const bool touch = view.balls[1].position_m.x() - view.balls[0].position_m.x() < 1.01;
        EXPECT_EQ(touch, knows_the_level);
    }
}

TEST(ArenaMirror, draws_on_whatever_platform_a_server_names) {
    ArenaMirror mirror;
    mirror.apply(welcome());
    replication::LevelStarted level;
    level.number = 1;
    level.platform = physics::Disc{-3.0};
    mirror.apply(level);
    mirror.add(two_balls(60, 2.0, 1.0));
    mirror.add(two_balls(63, 1.95, 1.0));
    EXPECT_NEAR(mirror.view_at(61.5 / 60.0).balls[1].position_m.x(), 1.975, 1e-3);
}

TEST(ArenaMirror, counts_a_phase_down_to_zero_and_no_further) {
    ArenaMirror mirror;
    auto only = snapshot(60);
    only->phase_end_tick = 120;
    mirror.add(only);
    EXPECT_DOUBLE_EQ(mirror.view_at(1.0).phase_remaining_s, 1.0);
    EXPECT_DOUBLE_EQ(mirror.view_at(1.5).phase_remaining_s, 0.5);
    EXPECT_DOUBLE_EQ(mirror.view_at(9.0).phase_remaining_s, 0.0);
}

TEST(ArenaMirror, names_balls_from_the_roster_without_control_characters) {
    ArenaMirror mirror;
    mirror.apply(welcome());
    replication::PlayerInfo ada;
    ada.player_id = 9;
    ada.name = "Ada\x1b[31m";
    ada.colour = 3;
    mirror.apply(replication::Roster{{ada}});
    mirror.add(snapshot(60));
    const View view = mirror.view_at(1.0);
    ASSERT_TRUE(view.own_ball);
    EXPECT_EQ(view.balls[0].name, "Ada?[31m");
    EXPECT_EQ(view.balls[0].colour, 3);
    ASSERT_NE(view.own_player(), nullptr);
}

TEST(ArenaMirror, gives_the_newest_snapshot_itself_with_its_level_and_the_own_player_at_a_glance) {
    ArenaMirror mirror;
    mirror.apply(welcome());
    EXPECT_EQ(mirror.glance_at(0.0).newest, nullptr);
    replication::PlayerInfo ada;
    ada.player_id = 9;
    ada.knock_offs = 4;
    mirror.apply(replication::Roster{{replication::PlayerInfo{}, ada}});
    mirror.add(snapshot(60));
    EXPECT_FALSE(mirror.glance_at(1.0).platform);
    replication::LevelStarted level;
    level.number = 1;
    level.platform = physics::Disc{7.0};
    mirror.apply(level);
    level.number = 2;
    mirror.apply(level);
    const auto newest = snapshot(62);
    mirror.add(newest);
    const Glance glance = mirror.glance_at(1.0);
    EXPECT_EQ(glance.newest, newest);
    ASSERT_TRUE(glance.platform);
    EXPECT_EQ(std::get<physics::Disc>(*glance.platform).radius_m, 7.0);
    ASSERT_TRUE(glance.own_player);
    EXPECT_EQ(glance.own_player->knock_offs, 4);
}

TEST(ArenaMirror, is_done_at_a_glance_with_what_came_before_it) {
    ArenaMirror mirror;
    for (replication::Tick tick = 2; tick < 2 * kMaxPendingHits; tick += 2) {
        auto next = snapshot(tick);
        next->hits.assign(2, {tick, 1, 2, 0, 0, 1});
        mirror.add(next);
        mirror.glance_at(tick / 60.0);
    }
    EXPECT_EQ(mirror.hits_dropped_count(), 0U);
    EXPECT_TRUE(mirror.view_at(2 * kMaxPendingHits / 60.0).hits.empty());
}

TEST(ArenaMirror, gives_up_the_oldest_hits_when_nobody_looks_and_counts_them) {
    ArenaMirror mirror;
    std::uint64_t added = 0;
    for (replication::Tick tick = 2; added <= kMaxPendingHits; tick += 2) {
        auto next = snapshot(tick);
        for (std::uint16_t i = 0; i < 100; ++i) next->hits.push_back({tick, i, i, 0, 0, 1});
        added += next->hits.size();
        mirror.add(next);
    }
    EXPECT_EQ(mirror.hits_dropped_count(), added - kMaxPendingHits);
}

}  // namespace
}  // namespace fts::client
