// Bodies that stay in contact: pressed together, wedged, jammed. A tick must not turn into an
// endless row of collisions, and nothing may sink into anything.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/physics/solver_swept.h"
#include "common/physics/world.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

struct Load {
    std::uint64_t events = 0;
    std::uint32_t most_in_a_tick = 0;
};

Load run(World<double>& world, int ticks) {
    Load load;
    for (int tick = 0; tick < ticks; ++tick) {
        const StepReport report = world.step(kTick);
        EXPECT_FALSE(report.overrun) << "tick " << tick;
        EXPECT_TRUE(all_finite(world)) << "tick " << tick;
        EXPECT_LE(deepest_penetration_m(world), 1e-12) << "tick " << tick;
        load.events += report.events;
        load.most_in_a_tick = std::max(load.most_in_a_tick, report.events);
        if (testing::Test::HasFailure()) break;
    }
    return load;
}

TEST(Contact, two_balls_pushing_each_other_hit_once_a_tick_at_most) {
    Scene scene;
    scene.bodies.push_back({Vec2d(-0.5, 0), Vec2d::Zero(), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(0.5, 0), Vec2d::Zero(), 0.5, 1.3});
    World<double> world(scene);
    world.set_control(world.ids()[0], {Vec2d(20, 0), 2.0});
    world.set_control(world.ids()[1], {Vec2d(-20, 0), 2.0});
    EXPECT_EQ(run(world, 3000).most_in_a_tick, 1U);
}

TEST(Contact, a_ball_pushed_into_a_corner_stays_there) {
    Scene scene;
    scene.walls = Walls{Vec2d(-5, -5), Vec2d(5, 5)};
    scene.bodies.push_back({Vec2d(4.5, 4.5), Vec2d::Zero(), 0.5, 1.0});
    World<double> world(scene);
    world.set_control(world.ids()[0], {Vec2d(20, 30), 1.0});
    EXPECT_LE(run(world, 3000).most_in_a_tick, 2U);
    EXPECT_GT(world.body(world.ids()[0]).position_m.minCoeff(), 4.4);
}

TEST(Contact, a_ball_wedged_between_two_rocks_keeps_calm) {
    Scene scene;
    scene.walls = Walls{Vec2d(-10.4, -20), Vec2d(10.4, 20)};
    scene.bodies.push_back({Vec2d(-5.4, 0), Vec2d::Zero(), 5.0, kInfinite});
    scene.bodies.push_back({Vec2d(5.4, 0), Vec2d::Zero(), 5.0, kInfinite});
    scene.bodies.push_back({Vec2d(0, 3), Vec2d::Zero(), 0.5, 1.0});
    World<double> world(scene);
    world.set_control(world.ids()[2], {Vec2d(0, -30), 1.0});
    EXPECT_LT(run(world, 3000).most_in_a_tick, 64U);
    EXPECT_NEAR(world.body(world.ids()[2]).position_m.y(), std::sqrt(5.5 * 5.5 - 5.4 * 5.4), 0.05);
}

TEST(Contact, a_light_ball_between_heavy_ones_that_press_it_keeps_calm) {
    Scene scene;
    scene.bodies.push_back({Vec2d(-1, 0), Vec2d::Zero(), 0.5, 1e4});
    scene.bodies.push_back({Vec2d(0, 0), Vec2d::Zero(), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(1, 0), Vec2d::Zero(), 0.5, 1e4});
    World<double> world(scene);
    world.set_control(world.ids()[0], {Vec2d(5, 0), 1.0});
    world.set_control(world.ids()[2], {Vec2d(-5, 0), 1.0});
    run(world, 300);
}

TEST(Contact, a_crowd_thrusting_into_a_corner_jams_without_overrun) {
    for (const std::uint64_t seed : {41U, 42U}) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        World<double> world(random_gas({.balls = 40, .max_speed_mps = 0.0}, dice));
        for (const BodyId id : world.ids()) world.set_control(id, {Vec2d(20, 12), 2.0});
        EXPECT_GT(run(world, 200).events, 500U);
    }
}

TEST(Contact, a_crowd_rushing_to_one_point_jams_without_overrun) {
    constexpr std::uint64_t kSeed = 43;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    World<double> world(random_gas({.balls = 60, .walled = false}, dice));
    for (int second = 0; second < 4; ++second) {
        for (int tick = 0; tick < 60; ++tick) {
            for (const BodyId id : world.ids()) {
                const Vec2d inwards = -world.body(id).position_m.normalized();
                world.set_control(id, {20.0 * inwards, 2.0});
            }
            run(world, 1);
        }
    }
}

TEST(Contact, a_packed_rack_at_rest_stays_at_rest) {
    Scene scene;
    for (int row = 0; row < 8; ++row) {
        for (int i = 0; i <= row; ++i) {
            scene.bodies.push_back(
                {Vec2d(i - 0.5 * row, row * std::sqrt(0.75)), Vec2d::Zero(), 0.5, 1.0});
        }
    }
    ASSERT_FALSE(validate(scene));
    World<double> world(scene);
    EXPECT_EQ(run(world, 60).events, 0U);
}

TEST(Contact, a_broken_rack_keeps_energy_and_momentum) {
    Scene scene;
    for (int row = 0; row < 12; ++row) {
        for (int i = 0; i <= row; ++i) {
            scene.bodies.push_back(
                {Vec2d(i - 0.5 * row, row * std::sqrt(0.75)), Vec2d::Zero(), 0.5, 1.0});
        }
    }
    scene.bodies.push_back({Vec2d(0.1, -5), Vec2d(0, 30), 0.5, 1.0});
    World<double> world(scene);
    EXPECT_GT(run(world, 120).events, 50U);
    EXPECT_NEAR(world.kinetic_energy_j(), 450.0, 1e-10);
    EXPECT_LE((world.momentum_ns() - Vec2d(0, 30)).norm(), 1e-12);
}

TEST(Contact, a_cradle_passes_the_blow_to_the_last_ball) {
    Scene scene;
    for (int i = 0; i < 6; ++i) {
        scene.bodies.push_back({Vec2d(i, 0), Vec2d::Zero(), 0.5, 1.0});
    }
    scene.bodies[0] = {Vec2d(-3, 0), Vec2d(2, 0), 0.5, 1.0};
    World<double> world(scene);
    world.step(3.0);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(world.body(world.ids()[i]).velocity_mps, Vec2d(0, 0)) << i;
    }
    EXPECT_EQ(world.body(world.ids()[5]).velocity_mps, Vec2d(2, 0));
}

TEST(Contact, balls_that_lose_energy_collapse_without_overrun) {
    for (const double restitution : {0.0, 0.1, 0.5, 0.9}) {
        SCOPED_TRACE(restitution);
        constexpr std::uint64_t kSeed = 44;
        Dice dice(kSeed);
        Scene scene = random_gas({.balls = 25}, dice);
        scene.restitution = restitution;
        World<double> world(scene);
        const double energy = world.kinetic_energy_j();
        run(world, 60);
        EXPECT_LT(world.kinetic_energy_j(), energy);
        for (const BodyId id : world.ids()) world.set_control(id, {Vec2d(20, 12), 0.5});
        run(world, 60);
    }
}

// A ball that exactly fills the room between two rocks hits them for ever; no order of events ends
// that.
Scene endless() {
    Scene scene;
    scene.bodies.push_back({Vec2d(-1, 0), Vec2d::Zero(), 0.5, kInfinite});
    scene.bodies.push_back({Vec2d(0, 0), Vec2d(1, 0), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(1 + 1e-9, 0), Vec2d::Zero(), 0.5, kInfinite});
    scene.bodies.push_back({Vec2d(0, 8), Vec2d(0, -600), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(0, 4), Vec2d(0, 0), 0.5, 1.0});
    return scene;
}

TEST(Overrun, is_reported_with_the_time_left_and_leaves_a_valid_state) {
    World<double> world(endless());
    const double energy = world.kinetic_energy_j();
    const StepReport report = world.step(kTick);
    EXPECT_TRUE(report.overrun);
    EXPECT_EQ(report.events, event_budget(world.size()));
    EXPECT_GT(report.unspent_time_s, 0.0);
    EXPECT_LT(report.unspent_time_s, kTick);
    EXPECT_LE(deepest_penetration_m(world), 1e-12);
    EXPECT_TRUE(all_finite(world));
    EXPECT_NEAR(world.kinetic_energy_j(), energy, 1e-9);
    // Everybody stands where they are at the time that was reached.
    EXPECT_NEAR(world.body(world.ids()[3]).position_m.y(),
                8.0 - 600.0 * (kTick - report.unspent_time_s), 1e-12);
}

TEST(Overrun, is_not_reported_when_the_budget_just_suffices) {
    Scene scene;
    scene.walls = Walls{Vec2d(-1, -50), Vec2d(1, 50)};
    scene.bodies.push_back({Vec2d(0, 0), Vec2d(1, 0), 0.5, 1.0});
    World<double> world(scene);
    const double budget = event_budget(1);
    const StepReport just = world.step(budget);
    EXPECT_EQ(just.events, event_budget(1));
    EXPECT_FALSE(just.overrun);
    EXPECT_EQ(just.unspent_time_s, 0.0);
    const StepReport more = world.step(budget + 1.0);
    EXPECT_TRUE(more.overrun);
    EXPECT_NEAR(more.unspent_time_s, 1.5, 1e-9);
}

TEST(Overrun, a_squeezed_ball_never_becomes_infinitely_fast) {
    Scene scene = endless();
    scene.bodies[0].velocity_mps = {1, 0};
    World<double> world(scene);
    for (int tick = 0; tick < 20; ++tick) {
        world.step(kTick);
        ASSERT_TRUE(all_finite(world));
        ASSERT_LE(deepest_penetration_m(world), 1e-12);
    }
}

}  // namespace
}  // namespace fts::physics
