// The algorithm of 2013 as a solver: right for one collision, wrong where and when it happens.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/physics/solver_seed.h"
#include "common/physics/world.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

template <typename Scalar>
class SeedSolver : public testing::Test {};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(SeedSolver, Scalars);

SolverChoice seed_solver(std::uint32_t substeps = 1) {
    return {SolverKind::kSeed, substeps};
}

template <typename Scalar>
double tolerance() {
    return std::is_same_v<Scalar, double> ? 1e-12 : 1e-5;
}

TYPED_TEST(SeedSolver, answers_an_overlap_as_the_discrete_solver_does) {
    constexpr std::uint64_t kSeed = 2013;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    int hits = 0;
    for (int i = 0; i < 500; ++i) {
        Scene scene;
        scene.restitution = i % 2 == 0 ? 1.0 : dice.between(0.0, 1.0);
        for (int k = 0; k < 2; ++k) {
            scene.bodies.push_back(
                {dice.in_box(1.0), dice.in_box(5.0), 1.5, dice.of_any_size(1e-2, 1e2)});
        }
        World<TypeParam> museum(scene, seed_solver());
        World<TypeParam> discrete(scene, {SolverKind::kDiscrete, 1});
        museum.step(TypeParam(0));
        discrete.step(TypeParam(0));
        ASSERT_EQ(museum.contacts().size(), discrete.contacts().size());
        hits += static_cast<int>(museum.contacts().size());
        for (const BodyId id : museum.ids()) {
            const auto one = museum.body(id), other = discrete.body(id);
            const auto off_m = (one.position_m - other.position_m).norm();
            const auto off_mps = (one.velocity_mps - other.velocity_mps).norm();
            EXPECT_LE(static_cast<double>(off_m), 10 * tolerance<TypeParam>());
            EXPECT_LE(static_cast<double>(off_mps), 10 * tolerance<TypeParam>());
        }
    }
    EXPECT_GT(hits, 150);
}

TYPED_TEST(SeedSolver, exchanges_the_velocities_of_equal_balls_head_on) {
    Scene scene;
    scene.bodies = {{{-1.05, 0.0}, {3.0, 0.0}, 1.0, 1.0}, {{1.05, 0.0}, {-2.0, 0.0}, 1.0, 1.0}};
    World<TypeParam> world(scene, seed_solver(4));
    for (int tick = 0; tick < 30; ++tick) world.step(static_cast<TypeParam>(kTick));
    EXPECT_EQ(world.audit().ball_collisions, 1U) << "parted balls are not answered again";
    const auto view = [&](std::size_t i) { return world.body(world.ids()[i]); };
    EXPECT_NEAR(static_cast<double>(view(0).velocity_mps.x()), -2.0, tolerance<TypeParam>());
    EXPECT_NEAR(static_cast<double>(view(1).velocity_mps.x()), 3.0, tolerance<TypeParam>());
}

TYPED_TEST(SeedSolver, keeps_energy_and_momentum_as_well_as_sines_and_cosines_do) {
    constexpr std::uint64_t kSeed = 91;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene = random_gas({.balls = 30, .half_width_m = 6.0, .max_speed_mps = 8.0}, dice);
    scene.periodic = Periodic{scene.walls->min_m, scene.walls->max_m};
    scene.walls.reset();
    World<TypeParam> world(scene, seed_solver(2));
    const double energy = world.kinetic_energy_j();
    const Vec2d momentum = world.momentum_ns();
    for (int tick = 0; tick < 600; ++tick) world.step(static_cast<TypeParam>(kTick));
    EXPECT_GT(world.audit().ball_collisions, 500U);
    EXPECT_LE(std::abs(world.kinetic_energy_j() / energy - 1.0), 10 * tolerance<TypeParam>());
    EXPECT_LE((world.momentum_ns() - momentum).norm(), 1e3 * tolerance<TypeParam>());
    for (const BodyId id : world.ids()) {
        const auto position = world.body(id).position_m;
        EXPECT_LE(static_cast<double>(position.cwiseAbs().maxCoeff()), 6.0);
    }
}

TYPED_TEST(SeedSolver, meets_through_the_side_of_a_periodic_box) {
    Scene scene;
    scene.periodic = Periodic{{0.0, 0.0}, {10.0, 10.0}};
    scene.bodies = {{{0.9, 5.0}, {-3.0, 0.0}, 1.0, 1.0}, {{9.1, 5.0}, {3.0, 0.0}, 1.0, 1.0}};
    World<TypeParam> world(scene, seed_solver());
    world.step(TypeParam(0));
    ASSERT_EQ(world.contacts().size(), 1U);
    EXPECT_EQ(world.contacts()[0].normal.x(), TypeParam(1));
    EXPECT_NEAR(static_cast<double>(world.contacts()[0].penetration), 0.2, 1e-5);
    EXPECT_LE(world.deepest_overlap(), 1e-5);
}

TYPED_TEST(SeedSolver, treats_an_infinite_mass_as_the_limit_of_eleven) {
    Scene scene;
    const double infinity = std::numeric_limits<double>::infinity();
    scene.bodies = {{{0.0, 0.0}, {0.25, 0.0}, 1.0, infinity},
                    {{1.9, 0.0}, {-3.0, 1.0}, 1.0, 2.0},
                    {{0.1, 0.0}, {0.0, 0.0}, 0.5, infinity}};
    World<TypeParam> world(scene, seed_solver());
    world.step(TypeParam(0));
    ASSERT_EQ(world.contacts().size(), 1U);
    const auto view = [&](std::size_t i) { return world.body(world.ids()[i]); };
    EXPECT_EQ(view(0).velocity_mps.x(), TypeParam(0.25));
    EXPECT_EQ(view(0).position_m.x(), TypeParam(0));
    EXPECT_NEAR(static_cast<double>(view(1).velocity_mps.x()), 3.5, 1e-5);
    EXPECT_NEAR(static_cast<double>(view(1).velocity_mps.y()), 1.0, 1e-5);
    EXPECT_TRUE(all_finite(world));
}

TYPED_TEST(SeedSolver, reflects_from_walls_and_drops_who_is_off) {
    Scene scene;
    scene.walls = Walls{{-5.0, -5.0}, {5.0, 5.0}};
    scene.platform = Disc{4.5};
    scene.bodies = {{{3.9, 0.0}, {12.0, 0.0}, 1.0, 1.0}, {{-4.4, 0.0}, {-60.0, 0.0}, 0.1, 1.0}};
    World<TypeParam> world(scene, seed_solver());
    world.step(static_cast<TypeParam>(kTick));
    EXPECT_EQ(world.audit().wall_collisions, 2U);
    ASSERT_EQ(world.falls().size(), 1U);
    ASSERT_EQ(world.size(), 1U);
    EXPECT_EQ(world.body(world.ids()[0]).velocity_mps.x(), TypeParam(-12));
    EXPECT_NEAR(static_cast<double>(world.body(world.ids()[0]).position_m.x()), 4.0, 1e-6);
}

TYPED_TEST(SeedSolver, lets_coincident_centres_be_until_they_have_moved_on) {
    Scene scene;
    scene.bodies = {{{1.0, 1.0}, {1.0, 0.0}, 1.0, 1.0}, {{1.0, 1.0}, {0.0, 0.0}, 1.0, 1.0}};
    World<TypeParam> world(scene, seed_solver());
    world.step(TypeParam(0));
    EXPECT_TRUE(world.contacts().empty());
    world.step(static_cast<TypeParam>(kTick));
    EXPECT_LE(world.deepest_overlap(), 1e-6);
    EXPECT_TRUE(all_finite(world));
}

}  // namespace
}  // namespace fts::physics
