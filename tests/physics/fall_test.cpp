// A body leaves the platform at the moment its centre crosses the edge.
#include <cmath>

#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

struct Roll {
    const char* name;
    Platform platform;
    Vec2d from_m, velocity_mps;
    double time_s;
    Vec2d edge_m;
};

const Roll kRolls[] = {
    {"disc", Disc{4.0}, {1, 0}, {2, 0}, 1.5, {4, 0}},
    {"disc, chord", Disc{5.0}, {-4, 3}, {4, 0}, 2.0, {4, 3}},
    {"rectangle", Rectangle{{4, 2}}, {1, 0}, {1, -2}, 1.0, {2, -2}},
    {"rectangle, corner", Rectangle{{4, 2}}, {0, 0}, {2, 1}, 2.0, {4, 2}},
    {"ring, outwards", Ring{1.0, 4.0}, {0, -2}, {0, -1}, 2.0, {0, -4}},
    {"ring, inwards", Ring{1.0, 4.0}, {3, 0}, {-2, 0}, 1.0, {1, 0}},
    {"ring, into the hole off centre", Ring{5.0, 9.0}, {-8, 3}, {2, 0}, 2.0, {-4, 3}},
};

World<double> roll(const Roll& r) {
    Scene scene;
    scene.platform = r.platform;
    scene.bodies.push_back({r.from_m, r.velocity_mps, 0.5, 1.0});
    return World<double>(scene);
}

TEST(Fall, comes_when_the_centre_crosses_the_edge) {
    for (const Roll& r : kRolls) {
        SCOPED_TRACE(r.name);
        World<double> world = roll(r);
        const BodyId ball = world.ids()[0];
        EXPECT_EQ(world.step(r.time_s + 0.5).events, 1U);
        ASSERT_EQ(world.falls().size(), 1U);
        const Fall<double>& fall = world.falls()[0];
        EXPECT_EQ(fall.id, ball);
        EXPECT_DOUBLE_EQ(fall.time_s, r.time_s);
        EXPECT_LE((fall.position_m - r.edge_m).norm(), 1e-14);
        EXPECT_EQ(fall.velocity_mps, r.velocity_mps);
        EXPECT_FALSE(world.contains(ball));
        EXPECT_EQ(world.size(), 0U);
        world.step(1.0);
        EXPECT_TRUE(world.falls().empty());
    }
}

TEST(Fall, comes_at_the_same_time_at_any_tick_rate) {
    for (const Roll& r : kRolls) {
        for (const int rate_hz : {7, 60, 1000}) {
            SCOPED_TRACE(r.name);
            World<double> world = roll(r);
            for (int tick = 0; tick < 10 * rate_hz; ++tick) {
                world.step(1.0 / rate_hz);
                if (world.falls().empty()) continue;
                EXPECT_NEAR(tick * (1.0 / rate_hz) + world.falls()[0].time_s, r.time_s, 1e-12);
                break;
            }
            EXPECT_EQ(world.size(), 0U);
        }
    }
}

TEST(Fall, a_body_may_stand_on_the_very_edge) {
    Scene scene;
    scene.platform = Disc{4.0};
    scene.bodies.push_back({Vec2d(4, 0), Vec2d::Zero(), 0.5, 1.0});
    World<double> world(scene);
    for (int tick = 0; tick < 60; ++tick) world.step(1.0 / 60.0);
    EXPECT_EQ(world.size(), 1U);
}

TEST(Fall, a_body_pushed_while_on_the_edge_falls_at_once) {
    Scene scene;
    scene.platform = Disc{4.0};
    scene.bodies.push_back({Vec2d(4, 0), Vec2d::Zero(), 0.5, 1.0});
    World<double> world(scene);
    world.set_control(world.ids()[0], {Vec2d(1e-3, 0), 0.0});
    world.step(1.0 / 60.0);
    ASSERT_EQ(world.falls().size(), 1U);
    EXPECT_EQ(world.falls()[0].time_s, 0.0);
}

TEST(Fall, a_body_that_turns_before_the_edge_stays) {
    Scene scene;
    scene.platform = Disc{4.0};
    scene.bodies.push_back({Vec2d(3, 0), Vec2d(2, 0), 0.5, 1.0});
    World<double> world(scene);
    world.set_control(world.ids()[0], {Vec2d(-2.1, 0), 0.0});  // stops after 0.952 m
    for (int tick = 0; tick < 100; ++tick) world.step(1.0 / 60.0);
    EXPECT_EQ(world.size(), 1U);
}

TEST(Fall, a_rival_knocked_off_falls_later_in_the_same_step) {
    Scene scene;
    scene.platform = Rectangle{{4, 4}};
    scene.bodies.push_back({Vec2d(0, 0), Vec2d(4, 0), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(3, 0), Vec2d(0, 0), 0.5, 1.0});
    World<double> world(scene);
    const BodyId hitter = world.ids()[0], victim = world.ids()[1];
    world.step(1.0);
    ASSERT_EQ(world.contacts().size(), 1U);
    EXPECT_DOUBLE_EQ(world.contacts()[0].time_s, 0.5);
    ASSERT_EQ(world.falls().size(), 1U);
    EXPECT_EQ(world.falls()[0].id, victim);
    EXPECT_DOUBLE_EQ(world.falls()[0].time_s, 0.75);
    EXPECT_TRUE(world.contains(hitter));
}

TEST(Fall, what_has_fallen_is_in_nobodys_way) {
    Scene scene;
    scene.platform = Rectangle{{4, 4}};
    scene.bodies.push_back({Vec2d(3.5, 0), Vec2d(1, 0), 0.5, 1.0});   // falls at 0.5 s
    scene.bodies.push_back({Vec2d(4, 3.5), Vec2d(0, -3), 0.5, 1.0});  // would hit it at (4, 0)
    World<double> world(scene);
    world.step(2.0);
    EXPECT_TRUE(world.contacts().empty());
    EXPECT_EQ(world.falls().size(), 1U);
    EXPECT_EQ(world.size(), 1U);
}

TEST(Fall, a_crowd_on_the_run_empties_every_platform) {
    for (const Platform& platform :
         {Platform(Disc{15.0}), Platform(Rectangle{{11, 12}}), Platform(Ring{1.0, 15.0})}) {
        constexpr std::uint64_t kSeed = 31;
        SCOPED_TRACE(kSeed);
        Dice dice(kSeed);
        Scene scene = random_gas({.balls = 60, .walled = false}, dice);
        scene.platform = platform;
        std::erase_if(scene.bodies, [&](const BodyDef& body) {
            return distance_to_edge_m(platform, body.position_m) < 0.0;
        });
        World<double> world(scene);
        const std::size_t before = world.size();
        std::size_t fallen = 0;
        for (int tick = 0; tick < 3600; ++tick) {
            world.step(1.0 / 60.0);
            for (const Fall<double>& fall : world.falls()) {
                ++fallen;
                ASSERT_NEAR(distance_to_edge_m(platform, fall.position_m), 0.0, 1e-13);
                ASSERT_FALSE(world.contains(fall.id));
            }
            for (const BodyId id : world.ids()) {
                ASSERT_GE(distance_to_edge_m(platform, world.body(id).position_m), -1e-13);
            }
        }
        EXPECT_EQ(fallen + world.size(), before);
        EXPECT_GT(fallen, before * 3 / 4);
    }
}

}  // namespace
}  // namespace fts::physics
