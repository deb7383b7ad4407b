// The exact solvers at the ends of what a scene may hold: masses, sizes, speeds, places, angles.
// Each test names the figure that it holds.
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

class Extremes : public testing::TestWithParam<SolverKind> {
  protected:
    World<double> world_of(const Scene& scene) const { return World<double>(scene, {GetParam()}); }
    static BodyView<double> nth(const World<double>& world, std::size_t n) {
        return world.body(world.ids()[n]);
    }
    static void run_until_collision(World<double>& world, int most_ticks = 1000) {
        for (int tick = 0; tick < most_ticks && world.audit().ball_collisions == 0; ++tick) {
            world.step(kTick);
        }
        ASSERT_EQ(world.audit().ball_collisions, 1U);
    }
};
INSTANTIATE_TEST_SUITE_P(Exact, Extremes, testing::Values(SolverKind::kSwept, SolverKind::kEvent),
                         name_of);

// A ball that comes from the left, with the impact parameter in units of the sum of radii.
Scene shot(double impact_parameter, double mass_kg, double target_mass_kg) {
    const double reach = 1.0;
    Scene scene;
    scene.bodies = {{Vec2d(-3.0, impact_parameter * reach), Vec2d(4.0, 0.0), 0.5, mass_kg},
                    {Vec2d::Zero(), Vec2d::Zero(), 0.5, target_mass_kg}};
    return scene;
}

TEST_P(Extremes, mass_ratios_from_1e_minus_12_to_1e12_keep_energy_and_momentum_to_1e_minus_15) {
    for (int exponent = -12; exponent <= 12; ++exponent) {
        SCOPED_TRACE(exponent);
        const double mass_kg = std::pow(10.0, std::ceil(exponent / 2.0));
        const double target_kg = std::pow(10.0, std::ceil(exponent / 2.0) - exponent);
        World<double> world = world_of(shot(0.6, mass_kg, target_kg));
        run_until_collision(world);
        EXPECT_LT(world.audit().worst_energy_error, 1e-15);
        EXPECT_LT(world.audit().worst_momentum_error, 1e-15);
        // v2 = 2 m1 / (m1 + m2) u cos(theta) along the line of centres, cos(theta) = 0.8.
        const double expected_mps = 2.0 * mass_kg / (mass_kg + target_kg) * 4.0 * 0.8;
        EXPECT_NEAR(nth(world, 1).velocity_mps.norm() / expected_mps, 1.0, 1e-14);
    }
}

TEST_P(Extremes, an_infinite_mass_reflects_and_stays) {
    World<double> world = world_of(shot(0.6, 1.0, kInfinite));
    run_until_collision(world);
    EXPECT_EQ(nth(world, 1).velocity_mps, Vec2d::Zero());
    EXPECT_EQ(nth(world, 1).position_m, Vec2d::Zero());
    EXPECT_NEAR(nth(world, 0).velocity_mps.norm(), 4.0, 1e-14);
    // Reflected in the tangent: turned round by twice the angle whose sine is 0.6.
    EXPECT_NEAR(nth(world, 0).velocity_mps.x(), -4.0 * (0.8 * 0.8 - 0.6 * 0.6), 1e-14);
}

// A row of ever larger balls, the smallest thrown at the next, which throws nothing: each hit is
// followed to the end.
TEST_P(Extremes, radii_from_1e_minus_6_to_1e6_in_one_scene_touch_to_round_off) {
    Scene scene;
    double edge_m = 0.0;
    for (int exponent = -6; exponent <= 6; ++exponent) {
        const double radius_m = std::pow(10.0, exponent);
        scene.bodies.push_back({Vec2d(edge_m + 1.5 * radius_m, 0.1 * radius_m),
                                Vec2d(exponent == -6 ? 1.0 : 0.0, 0.0), radius_m, 1.0});
        edge_m += 2.5 * radius_m;
    }
    ASSERT_FALSE(validate(scene));
    World<double> world = world_of(scene);
    const double energy_j = world.kinetic_energy_j();
    const Vec2d momentum_ns = world.momentum_ns();
    double deepest = 0.0;
    for (int tick = 0; tick < 1200; ++tick) {
        ASSERT_FALSE(world.step(100.0 * kTick).overrun);
        for (const auto& contact : world.contacts()) {
            deepest = std::max(deepest, contact.penetration);
        }
    }
    EXPECT_GE(world.audit().ball_collisions, 4U);
    EXPECT_NEAR(world.kinetic_energy_j() / energy_j, 1.0, 1e-14);
    EXPECT_LT((world.momentum_ns() - momentum_ns).norm(), 1e-14);
    EXPECT_LT(deepest, 1e-12);
    EXPECT_TRUE(all_finite(world));
}

TEST_P(Extremes, speeds_from_1e_minus_12_to_1e6_radii_a_tick_exchange_to_1e_minus_15) {
    constexpr double kRadiusM = 0.5;
    for (int exponent = -12; exponent <= 6; ++exponent) {
        SCOPED_TRACE(exponent);
        const double step_m = std::pow(10.0, exponent) * kRadiusM;
        const double gap_m = 10.0 * step_m;
        Scene scene;
        scene.bodies = {{Vec2d(-kRadiusM - gap_m, 0.0), Vec2d(step_m / kTick, 0.0), kRadiusM, 1.0},
                        {Vec2d(kRadiusM, 0.0), Vec2d::Zero(), kRadiusM, 1.0}};
        World<double> world = world_of(scene);
        for (int tick = 0; tick < 9; ++tick) world.step(kTick);
        ASSERT_EQ(world.audit().ball_collisions, 0U);
        for (int tick = 0; tick < 2; ++tick) world.step(kTick);
        ASSERT_EQ(world.audit().ball_collisions, 1U);
        const double speed_mps = step_m / kTick;
        EXPECT_LE(nth(world, 0).velocity_mps.norm(), 1e-15 * speed_mps);
        EXPECT_LE((nth(world, 1).velocity_mps - Vec2d(speed_mps, 0.0)).norm(), 1e-15 * speed_mps);
    }
}

// The places of bodies are as fine as doubles are there: 1e-10 of a radius at a million radii, 1e-7
// at a thousand million. Collisions happen all the same, and conserve to the last bits.
TEST_P(Extremes, far_from_the_origin_collisions_are_as_good_as_the_places_are) {
    const struct { double away_m, figure; } cases[] = {{1e6, 1e-9}, {9e8, 1e-6}};
    for (const auto& [away_m, figure] : cases) {
        SCOPED_TRACE(away_m);
        Scene near = shot(0.6, 1.0, 3.0), far = near;
        for (BodyDef& body : far.bodies) body.position_m += Vec2d(away_m, -away_m);
        World<double> here = world_of(near), there = world_of(far);
        run_until_collision(here);
        run_until_collision(there);
        for (std::size_t n = 0; n < 2; ++n) {
            EXPECT_LT((nth(here, n).velocity_mps - nth(there, n).velocity_mps).norm(), figure);
        }
        EXPECT_LT(there.audit().worst_energy_error, 1e-15);
        EXPECT_LT(there.audit().worst_momentum_error, 1e-15);
    }
}

// cos(theta) = sqrt(1 - b^2): what 16 digits of b leave of it are about 4.
TEST_P(Extremes, a_grazing_hit_at_one_minus_1e_minus_12_deflects_right_to_four_digits) {
    const double impact_parameter = 1.0 - 1e-12;
    World<double> world = world_of(shot(impact_parameter, 1.0, 1.0));
    run_until_collision(world);
    const double cosine = std::sqrt((1.0 - impact_parameter) * (1.0 + impact_parameter));
    EXPECT_NEAR(nth(world, 1).velocity_mps.norm() / (4.0 * cosine), 1.0, 2e-4);
    EXPECT_LT(world.audit().worst_energy_error, 1e-15);

    World<double> miss = world_of(shot(1.0 + 1e-12, 1.0, 1.0));
    for (int tick = 0; tick < 120; ++tick) miss.step(kTick);
    EXPECT_EQ(miss.audit().ball_collisions, 0U);
}

TEST_P(Extremes, coincident_centres_part_as_they_came) {
    for (const Vec2d& velocity : {Vec2d(1.0, 2.0), Vec2d(0.0, 0.0)}) {
        Scene scene;
        scene.bodies = {{Vec2d(1.0, 1.0), velocity, 0.5, 1.0},
                        {Vec2d(1.0, 1.0), -velocity, 0.5, 2.0}};
        ASSERT_TRUE(validate(scene));
        ASSERT_FALSE(validate(scene, Overlaps::kAccepted));
        World<double> world = world_of(scene);
        for (int tick = 0; tick < 60; ++tick) ASSERT_FALSE(world.step(kTick).overrun);
        EXPECT_TRUE(all_finite(world));
        EXPECT_NEAR(world.kinetic_energy_j(), 1.5 * velocity.squaredNorm(), 1e-14);
    }
}

TEST_P(Extremes, overlapping_starts_collide_once_while_they_approach_and_never_while_they_part) {
    for (const double closing : {1.0, -1.0}) {
        Scene scene;
        scene.bodies = {{Vec2d(-0.3, 0.0), Vec2d(closing, 0.0), 0.5, 1.0},
                        {Vec2d(0.3, 0.0), Vec2d(-closing, 0.0), 0.5, 1.0}};
        World<double> world = world_of(scene);
        for (int tick = 0; tick < 60; ++tick) ASSERT_FALSE(world.step(kTick).overrun);
        EXPECT_EQ(world.audit().ball_collisions, closing > 0.0 ? 1U : 0U);
        EXPECT_EQ(nth(world, 0).velocity_mps, Vec2d(-1.0, 0.0));
        EXPECT_EQ(nth(world, 1).velocity_mps, Vec2d(1.0, 0.0));
    }
}

TEST_P(Extremes, a_heap_of_overlapping_balls_scatters_with_its_energy) {
    constexpr std::uint64_t kSeed = 31;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene;
    for (int i = 0; i < 60; ++i) {
        scene.bodies.push_back({dice.in_box(2.0), dice.in_box(3.0), 0.5, dice.between(0.5, 2.0)});
    }
    World<double> world = world_of(scene);
    const double energy_j = world.kinetic_energy_j();
    for (int tick = 0; tick < 600; ++tick) world.step(kTick);
    EXPECT_TRUE(all_finite(world));
    EXPECT_NEAR(world.kinetic_energy_j() / energy_j, 1.0, 1e-12);
    for (const BodyId a : world.ids()) {
        for (const BodyId b : world.ids()) {
            if (!(b < a)) break;
            const auto first = world.body(a), second = world.body(b);
            const Vec2d apart_m = first.position_m - second.position_m;
            if (apart_m.norm() >= 1.0 - 1e-12) continue;
            EXPECT_GE(apart_m.dot(first.velocity_mps - second.velocity_mps), 0.0)
                << "a pair that still overlaps approaches";
        }
    }
}

TEST_P(Extremes, balls_at_rest_that_touch_stay_to_the_last_bit) {
    Scene scene;
    for (int i = 0; i < 50; ++i) scene.bodies.push_back({Vec2d(i, 0.0), Vec2d::Zero(), 0.5, 1.0});
    World<double> world = world_of(scene);
    const std::uint64_t before = world.state_hash();
    for (int tick = 0; tick < 60; ++tick) EXPECT_EQ(world.step(kTick).events, 0U);
    EXPECT_EQ(world.state_hash(), before);
}

// Galperin's two balls and a wall: the collisions of masses 1 and 100^k count the digits of pi.
class DigitsOfPi : public Extremes {};
INSTANTIATE_TEST_SUITE_P(Exact, DigitsOfPi, testing::Values(SolverKind::kSwept, SolverKind::kEvent),
                         name_of);

TEST_P(DigitsOfPi, are_counted_to_the_seventh_by_two_balls_and_a_wall) {
    const std::uint64_t digits[] = {3, 31, 314, 3141, 31415, 314159, 3141592};
    double mass_kg = 1.0;
    for (const std::uint64_t expected : digits) {
        SCOPED_TRACE(mass_kg);
        Scene scene;
        scene.walls = {Vec2d(0.0, -1.0), Vec2d(1e9, 1.0)};
        scene.bodies = {{Vec2d(2.0, 0.0), Vec2d::Zero(), 0.5, 1.0},
                        {Vec2d(5.0, 0.0), Vec2d(-1.0, 0.0), 0.5, mass_kg}};
        World<double> world = world_of(scene);
        // The crowd of collisions at the turning point is more than one step's budget, and the last
        // one may be long in coming.
        for (double left_s = 1e5; left_s > 0.0;) {
            const double before_s = left_s;
            left_s = world.step(left_s).unspent_time_s;
            ASSERT_LE(left_s, before_s);
        }
        EXPECT_EQ(world.audit().ball_collisions + world.audit().wall_collisions, expected);
        mass_kg *= 100.0;
    }
}

}  // namespace
}  // namespace fts::physics
