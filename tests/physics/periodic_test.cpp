// A box whose opposite sides are one, with exact times of impact.
#include "common/physics/periodic.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "tests/physics/allocation_count.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

Scene empty_torus(double width_m, double height_m) {
    Scene scene;
    scene.periodic = Periodic{Vec2d::Zero(), Vec2d(width_m, height_m)};
    return scene;
}

Scene periodic_gas(std::size_t balls, double width_m, Dice& dice) {
    Scene scene = random_gas(
        {.balls = balls, .half_width_m = 0.5 * width_m, .max_speed_mps = 10.0, .walled = false},
        dice);
    scene.periodic = Periodic{Vec2d::Constant(-0.5 * width_m), Vec2d::Constant(0.5 * width_m)};
    EXPECT_FALSE(validate(scene));
    return scene;
}

double sum_of_momenta_ns(const World<double>& world) {
    double sum = 0.0;
    for (const BodyId id : world.ids()) {
        sum += world.body(id).mass_kg * world.body(id).velocity_mps.norm();
    }
    return sum;
}

double deepest_periodic_penetration_m(const World<double>& world, const Scene& scene) {
    const Model<double>::Box box{scene.periodic->min_m, scene.periodic->max_m};
    double deepest = -1e300;
    for (const BodyId a : world.ids()) {
        for (const BodyId b : world.ids()) {
            if (!(b < a)) break;
            const auto first = world.body(a), second = world.body(b);
            const Vec2d apart = nearest_image<double>(first.position_m - second.position_m, box);
            deepest = std::max(deepest, first.radius_m + second.radius_m - apart.norm());
        }
    }
    return deepest;
}

void expect_inside(const World<double>& world, const Scene& scene) {
    for (const BodyId id : world.ids()) {
        const Vec2d position = world.body(id).position_m;
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_GE(position[axis], scene.periodic->min_m[axis]);
            EXPECT_LT(position[axis], scene.periodic->max_m[axis]);
        }
    }
}

TEST(Periodic, a_ball_that_leaves_on_one_side_enters_on_the_other) {
    Scene scene = empty_torus(10, 6);
    scene.bodies.push_back({Vec2d(9, 5), Vec2d(2, 2), 0.5, 1.0});
    World<double> world(scene);
    world.step(1.0);
    EXPECT_LT((world.body(world.ids()[0]).position_m - Vec2d(1, 1)).norm(), 1e-14);
    world.step(1000.0);
    EXPECT_LT((world.body(world.ids()[0]).position_m - Vec2d(1, 3)).norm(), 1e-10);
    expect_inside(world, scene);
    EXPECT_EQ(world.audit().ball_collisions, 0U);
}

TEST(Periodic, two_balls_meet_across_the_border) {
    Scene scene = empty_torus(10, 10);
    scene.bodies.push_back({Vec2d(1, 5), Vec2d(-1, 0), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(9, 5), Vec2d(1, 0), 0.5, 2.0});
    World<double> world(scene);
    world.step(0.75);
    ASSERT_EQ(world.contacts().size(), 1U);
    const Contact<double>& hit = world.contacts()[0];
    EXPECT_NEAR(hit.time_s, 0.5, 1e-14);
    EXPECT_EQ(hit.normal, Vec2d(1, 0));
    EXPECT_NEAR((hit.position_a_m - hit.position_b_m).norm(), 1.0, 1e-14);
    EXPECT_NEAR(world.kinetic_energy_j(), 1.5, 1e-15);
    EXPECT_LT((world.momentum_ns() - Vec2d(1, 0)).norm(), 1e-15);
}

TEST(Periodic, two_balls_meet_across_the_corner) {
    Scene scene = empty_torus(10, 10);
    scene.bodies.push_back({Vec2d(0.5, 0.5), Vec2d(-1, -1), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(9, 9), Vec2d(0, 0), 0.5, 1.0});
    World<double> world(scene);
    world.step(2.0);
    ASSERT_EQ(world.contacts().size(), 1U);
    EXPECT_NEAR(world.contacts()[0].normal.x(), std::sqrt(0.5), 1e-14);
    EXPECT_LT((world.body(world.ids()[0]).velocity_mps).norm(), 1e-14);
}

// Two balls on a ring meet in turn on one side and on the other, each time through another image.
TEST(Periodic, a_pair_meets_again_through_another_image) {
    for (const double speed : {1e-3, 1.0, 1e3, 1e5}) {
        SCOPED_TRACE(speed);
        Scene scene = empty_torus(10, 10);
        scene.bodies.push_back({Vec2d(3, 5), Vec2d(speed, 0), 0.5, 1.0});
        scene.bodies.push_back({Vec2d(8, 5), Vec2d(0, 0), 0.5, 1.0});
        World<double> world(scene);
        // They meet after 4 m, and then each time one has gone right round: 10 m less two
        // diameters.
        ASSERT_FALSE(world.step(402.0 / speed).overrun);
        EXPECT_EQ(world.contacts().size(), 50U);
        double sign = -1.0;
        for (const Contact<double>& hit : world.contacts()) {
            EXPECT_EQ(hit.normal.x(), sign);
            sign = -sign;
        }
        EXPECT_NEAR(world.kinetic_energy_j(), 0.5 * speed * speed, 1e-12 * speed * speed);
    }
}

TEST(Periodic, a_gas_keeps_energy_and_momentum_over_two_thousand_collisions) {
    for (const std::uint64_t seed : {601U, 602U}) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        const Scene scene = periodic_gas(40, 16.0, dice);
        World<double> world(scene);
        const double energy = world.kinetic_energy_j(), momenta = sum_of_momenta_ns(world);
        const Vec2d momentum = world.momentum_ns();
        while (world.audit().ball_collisions < 2000) {
            ASSERT_FALSE(world.step(kTick).overrun);
            ASSERT_LE(deepest_periodic_penetration_m(world, scene), 1e-12);
        }
        expect_inside(world, scene);
        EXPECT_NEAR(world.kinetic_energy_j() / energy, 1.0, 1e-12);
        EXPECT_LT((world.momentum_ns() - momentum).norm(), 1e-12 * momenta);
    }
}

TEST(Periodic, where_the_border_runs_does_not_matter) {
    constexpr std::uint64_t kSeed = 603;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene = periodic_gas(30, 15.0, dice);
    World<double> here(scene);
    const Vec2d third(5.0, 5.0);
    for (BodyDef& body : scene.bodies) {
        body.position_m = wrapped<double>(body.position_m + third,
                                          {scene.periodic->min_m, scene.periodic->max_m});
    }
    World<double> there(scene);
    std::size_t compared = 0;
    for (int tick = 0; tick < 30; ++tick) {
        here.step(kTick);
        there.step(kTick);
        ASSERT_EQ(here.contacts().size(), there.contacts().size());
        for (std::size_t i = 0; i < here.contacts().size(); ++i, ++compared) {
            const Contact<double>&one = here.contacts()[i], &other = there.contacts()[i];
            EXPECT_EQ(one.a, other.a);
            EXPECT_EQ(one.b, other.b);
            EXPECT_NEAR(one.time_s, other.time_s, 1e-10);
            EXPECT_LT((one.normal - other.normal).norm(), 1e-8);
        }
    }
    EXPECT_GT(compared, 20U);
}

TEST(Periodic, how_a_span_is_cut_into_ticks_does_not_matter) {
    constexpr std::uint64_t kSeed = 604;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    const Scene scene = periodic_gas(12, 15.0, dice);
    World<double> at_once(scene), in_ticks(scene);
    at_once.step(1.5);
    for (int tick = 0; tick < 64; ++tick) in_ticks.step(1.5 / 64);
    EXPECT_GT(at_once.audit().ball_collisions, 5U);
    EXPECT_EQ(at_once.audit().ball_collisions, in_ticks.audit().ball_collisions);
    for (const BodyId id : at_once.ids()) {
        EXPECT_LT((at_once.body(id).velocity_mps - in_ticks.body(id).velocity_mps).norm(), 1e-8);
    }
}

TEST(Periodic, a_collision_that_makes_a_light_ball_very_fast_loses_nobody) {
    Scene scene = empty_torus(10, 10);
    scene.bodies.push_back({Vec2d(2, 5), Vec2d(1, 0), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(4, 5), Vec2d(0, 0), 0.5, 1e-6});
    scene.bodies.push_back({Vec2d(8, 5.2), Vec2d(0, 0), 0.5, 1e-3});
    scene.bodies.push_back({Vec2d(6, 2), Vec2d(-500, 300), 0.5, 1e-6});
    World<double> world(scene);
    const double energy = world.kinetic_energy_j();
    for (int tick = 0; tick < 300; ++tick) {
        ASSERT_FALSE(world.step(kTick).overrun);
        ASSERT_LT(deepest_periodic_penetration_m(world, scene), 1e-12);
    }
    EXPECT_GT(world.audit().ball_collisions, 100U);
    EXPECT_NEAR(world.kinetic_energy_j() / energy, 1.0, 1e-12);
}

// Each is almost twice as fast as what hit it: the last goes round hundreds of times in one tick.
TEST(Periodic, a_row_of_ever_lighter_balls_ends_in_one_that_goes_round_and_round) {
    Scene scene = empty_torus(100, 100);
    for (int i = 0; i < 14; ++i) {
        const Vec2d place(2.0 * i, 2.0 * i);
        scene.bodies.push_back({place, Vec2d::Zero(), 0.5, std::pow(10.0, 8 - i)});
    }
    scene.bodies.front().velocity_mps = Vec2d(20.0, 20.0) / kTick;
    World<double> world(scene);
    const double energy = world.kinetic_energy_j();
    EXPECT_GE(world.step(kTick).events, 13U);
    const double fastest_mps = world.body(world.ids().back()).velocity_mps.norm();
    EXPECT_GT(fastest_mps * kTick, 100.0 * 100.0);
    EXPECT_NEAR(world.kinetic_energy_j() / energy, 1.0, 1e-12);
}

TEST(Periodic, at_a_million_radii_a_tick_is_exact_or_an_overrun) {
    Scene scene = empty_torus(10, 10);
    const double speed = 1e6 * 0.5 / kTick;
    scene.bodies.push_back({Vec2d(2, 5), Vec2d(speed, 0), 0.5, 1.0});
    World<double> alone(scene);
    EXPECT_FALSE(alone.step(kTick).overrun);
    EXPECT_NEAR(alone.body(alone.ids()[0]).position_m.x(), 2.0, 1e-6);
    scene.bodies.push_back({Vec2d(7, 5), Vec2d(0, 0), 0.5, 1.0});
    World<double> pair(scene);
    const StepReport report = pair.step(kTick);
    EXPECT_TRUE(report.overrun);
    EXPECT_GT(report.events, 4000U);
    EXPECT_NEAR(pair.kinetic_energy_j() / (0.5 * speed * speed), 1.0, 1e-12);
    EXPECT_LT(deepest_periodic_penetration_m(pair, scene), 1e-9);
    scene.bodies[0].velocity_mps = Vec2d(1e9, 0);
    scene.bodies.pop_back();
    World<double> faster(scene);
    EXPECT_TRUE(faster.step(kTick).overrun) << "needs more than kMaxStretches";
}

TEST(Periodic, a_row_of_touching_balls_right_round_passes_a_blow_across_the_border) {
    Scene scene = empty_torus(12, 12);
    for (int i = 0; i < 6; ++i) {
        scene.bodies.push_back({Vec2d((9 + i) % 12, 5), Vec2d::Zero(), 0.5, 1.0});
    }
    scene.bodies.push_back({Vec2d(6, 5), Vec2d(3, 0), 0.5, 1.0});
    World<double> world(scene);
    ASSERT_FALSE(world.step(1.0).overrun);
    EXPECT_EQ(world.body(world.ids()[5]).velocity_mps, Vec2d(3, 0));
    EXPECT_EQ(world.body(world.ids()[6]).velocity_mps, Vec2d(0, 0));
    EXPECT_EQ(world.contacts().size(), 6U);
}

TEST(Periodic, a_warm_world_asks_for_no_memory) {
    constexpr std::uint64_t kSeed = 606;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    World<double> world(periodic_gas(40, 16.0, dice));
    for (int tick = 0; tick < 600; ++tick) world.step(kTick);
    const std::size_t before = allocations();
    EXPECT_GT(before, 0U);
    for (int tick = 0; tick < 200; ++tick) world.step(kTick);
    EXPECT_EQ(allocations(), before);
}

TEST(Periodic, single_precision_holds_too) {
    constexpr std::uint64_t kSeed = 605;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    World<float> world(periodic_gas(40, 16.0, dice));
    const double energy = world.kinetic_energy_j();
    for (int tick = 0; tick < 300; ++tick) {
        ASSERT_FALSE(world.step(1.0F / 60.0F).overrun);
        ASSERT_TRUE(all_finite(world));
    }
    EXPECT_GT(world.audit().ball_collisions, 300U);
    EXPECT_NEAR(world.kinetic_energy_j() / energy, 1.0, 1e-4);
}

}  // namespace
}  // namespace fts::physics
