// Crowds that fly apart, collapse, overlap, or are stepped too far, in windows of time.
#include <cmath>

#include <gtest/gtest.h>

#include "common/physics/solver_swept.h"
#include "common/physics/world.h"
#include "tests/physics/crowds.h"
#include "tests/physics/event_lives.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

constexpr SolverChoice kInWindows{.kind = SolverKind::kEvent};

TEST(CrowdExtremes, a_crowd_that_flies_apart_in_the_open_keeps_its_energy_and_meets_no_more) {
    constexpr std::uint64_t kSeed = 527;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene = random_crowd({.max_speed_mps = 30.0}, dice);
    scene.walls.reset();
    const std::size_t first = scene.bodies.size();
    scene.bodies.push_back({Vec2d(-5e4, 7e4), Vec2d(99.0, 0.0), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(5e4, 7e4), Vec2d(-101.0, 0.0), 0.5, 1.0});
    World<double> world(scene, kInWindows);
    const double energy_j = world.kinetic_energy_j();
    const Vec2d momentum_ns = world.momentum_ns();
    for (int second = 0; second < 600; ++second) ASSERT_FALSE(world.step(1.0).overrun);
    EXPECT_GT(world.audit().ball_collisions, 300U);
    EXPECT_EQ(world.body(world.ids()[first]).velocity_mps, Vec2d(-101.0, 0.0));
    EXPECT_EQ(world.body(world.ids()[first + 1]).velocity_mps, Vec2d(99.0, 0.0));
    EXPECT_NEAR(world.kinetic_energy_j() / energy_j, 1.0, 1e-12);
    EXPECT_LT((world.momentum_ns() - momentum_ns).norm(), 1e-9);
    EXPECT_EQ(world.deepest_overlap(), 0.0);
}

TEST(CrowdExtremes, in_single_precision_all_stays_finite_and_energy_is_kept) {
    constexpr std::uint64_t kSeed = 528;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (const double far_m : {0.0, 1e3, 1e5}) {
        SCOPED_TRACE(far_m);
        CrowdShape shape{.max_radius_m = 1.5};
        shape.centre_m = Vec2d(far_m, -far_m);
        const Scene walled = random_crowd(shape, dice);
        Scene open = walled;
        open.walls.reset();
        for (const Scene& scene : {walled, open}) {
            World<float> world(scene, kInWindows);
            const double energy_j = world.kinetic_energy_j();
            for (int tick = 0; tick < 600; ++tick) {
                ASSERT_FALSE(world.step(static_cast<float>(kTick)).overrun) << tick;
                ASSERT_LT(world.deepest_overlap(), 1e-5 + 4e-7 * far_m) << tick;
            }
            EXPECT_TRUE(all_finite(world));
            EXPECT_NEAR(world.kinetic_energy_j() / energy_j, 1.0, 1e-4);
            EXPECT_GT(world.audit().ball_collisions, 300U);
        }
    }
}

// Too long a step is broken off with a report, at a moment that is a valid state.
TEST(CrowdExtremes, a_step_of_days_is_broken_off_with_a_report_and_the_next_goes_on) {
    constexpr std::uint64_t kSeed = 530;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (const double filled : {1e-4, 0.2}) {
        SCOPED_TRACE(filled);
        const Scene scene = random_crowd({.balls = 300, .filled = filled}, dice);
        World<double> world(scene, kInWindows);
        const double energy_j = world.kinetic_energy_j();
        double simulated_s = 0.0;
        for (int step = 0; step < 3; ++step) {
            const StepReport report = world.step(1e6);
            EXPECT_TRUE(report.overrun);
            EXPECT_LE(report.events, event_budget(300));
            EXPECT_GE(report.unspent_time_s, 0.0);
            EXPECT_LT(report.unspent_time_s, 1e6);
            simulated_s += 1e6 - report.unspent_time_s;
            EXPECT_LT(world.deepest_overlap(), 1e-12);
        }
        EXPECT_GT(simulated_s, 1.0);
        world.set_velocity(world.ids()[0], -world.body(world.ids()[0]).velocity_mps);
        EXPECT_FALSE(world.step(0.01).overrun);
        EXPECT_NEAR(world.kinetic_energy_j() / energy_j, 1.0, 1e-12);
    }
}

TEST(CrowdExtremes, what_is_left_of_a_broken_off_step_has_the_same_collisions_in_the_next) {
    constexpr std::uint64_t kSeed = 531;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Scene scene = random_crowd({.balls = 300, .filled = 0.25}, dice);
    World<double> broken(scene, kInWindows), whole(scene, kInWindows);
    double left_s = 200.0;
    std::uint32_t steps = 0;
    for (; left_s > 0.0 && steps < 100; ++steps) {
        const StepReport report = broken.step(left_s);
        left_s = report.unspent_time_s;
        if (!report.overrun) break;
    }
    EXPECT_GT(steps, 0U);
    for (int second = 0; second < 200; ++second) ASSERT_FALSE(whole.step(1.0).overrun);
    EXPECT_EQ(broken.audit().ball_collisions, whole.audit().ball_collisions);
    for (const BodyId id : whole.ids()) {
        ASSERT_EQ(broken.body(id).velocity_mps, whole.body(id).velocity_mps);
        ASSERT_LT((broken.position_m(id) - whole.position_m(id)).norm(), 1e-10);
    }
}

TEST(CrowdExtremes, an_inelastic_crowd_collapses_without_overrun) {
    for (const double restitution : {0.0, 0.1, 0.5, 0.9}) {
        SCOPED_TRACE(restitution);
        constexpr std::uint64_t kSeed = 534;
        Dice dice(kSeed);
        Scene scene = random_crowd({.max_radius_m = 0.7, .filled = 0.35}, dice);
        scene.restitution = restitution;
        expect_collapse_without_overrun(scene, 400);
    }
}

TEST(CrowdExtremes, balls_that_start_in_each_other_part_without_overrun) {
    constexpr std::uint64_t kSeed = 535;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene;
    for (int i = 0; i < 300; ++i) {
        scene.bodies.push_back({dice.in_box(4.0), dice.in_box(3.0), 0.5, dice.between(0.5, 2.0)});
    }
    scene.bodies[1].position_m = scene.bodies[0].position_m;
    expect_parting_without_overrun(scene);
}

TEST(CrowdExtremes,
     in_single_precision_the_clock_is_as_good_after_a_quarter_of_an_hour_as_at_once) {
    Scene scene;
    scene.walls = Walls{Vec2d(0.0, -2.0), Vec2d(8.0, 600.0)};
    for (int i = 0; i < 300; ++i) {  // to and fro in 8 s, each in its lane
        scene.bodies.push_back({Vec2d(4.0, 1.5 * i), Vec2d(1.75, 0.0), 0.5, 1.0});
    }
    World<float> world(scene, kInWindows);
    const float tick_s = 1.0F / 60.0F;
    for (int ticks = 60; ticks <= 54'000; ticks += 60) {
        for (int i = 0; i < 60; ++i) world.step(tick_s);
        const double time_s = ticks * static_cast<double>(tick_s);
        const double way_m = std::fmod(3.5 + 1.75 * time_s, 14.0);
        const double expected_m = 0.5 + (way_m < 7.0 ? way_m : 14.0 - way_m);
        for (const std::size_t i : {0U, 130U, 299U}) {
            const Vec2d seen_m = world.position_m(world.ids()[i]).cast<double>();
            ASSERT_NEAR(seen_m.x(), expected_m, 1e-6) << time_s;
            ASSERT_EQ(seen_m.y(), 1.5 * static_cast<double>(i));
        }
    }
}

}  // namespace
}  // namespace fts::physics
