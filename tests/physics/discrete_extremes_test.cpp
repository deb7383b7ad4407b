// The discrete solver where scenes are unkind: overlaps and coincident centres at the start,
// infinite masses, edges, huge distances and unequal radii.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/physics/diagnostics.h"
#include "common/physics/world.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

constexpr SolverChoice kDiscrete = {SolverKind::kDiscrete, 1};

template <typename Scalar>
class DiscreteExtremes : public testing::Test {};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(DiscreteExtremes, Scalars);

TYPED_TEST(DiscreteExtremes, parts_a_heap_of_balls_that_start_inside_each_other) {
    constexpr std::uint64_t kSeed = 61;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene;
    for (int i = 0; i < 60; ++i) scene.bodies.push_back({dice.in_box(2.0), {0.0, 0.0}, 0.5, 1.0});
    World<TypeParam> world(scene, kDiscrete);
    for (int tick = 0; tick < 3000; ++tick) world.step(static_cast<TypeParam>(kTick));
    EXPECT_LE(world.deepest_overlap(), 0.01);
    EXPECT_EQ(world.kinetic_energy_j(), 0.0) << "being moved apart is no motion";
    EXPECT_TRUE(all_finite(world));
}

TYPED_TEST(DiscreteExtremes, parts_coincident_centres_the_same_way_every_time) {
    Scene scene;
    scene.bodies = {{{1.0, 2.0}, {0.0, 0.0}, 0.5, 1.0},
                    {{1.0, 2.0}, {0.0, 0.0}, 0.5, 3.0},
                    {{9.0, 0.0}, {0.0, 2.0}, 0.5, 1.0},
                    {{9.0, 0.0}, {0.0, -2.0}, 0.5, 1.0}};
    World<TypeParam> world(scene, kDiscrete);
    world.step(TypeParam(0));
    EXPECT_TRUE(all_finite(world));
    EXPECT_LE(world.deepest_overlap(), 1e-6);
    const auto view = [&](std::size_t i) { return world.body(world.ids()[i]); };
    EXPECT_NEAR(static_cast<double>(view(0).position_m.x()), 1.75, 1e-6) << "the lower towards +x";
    EXPECT_NEAR(static_cast<double>(view(1).position_m.x()), 0.75, 1e-6);
    EXPECT_EQ(view(2).velocity_mps.y(), TypeParam(-2)) << "as if they had met head-on";
    EXPECT_EQ(view(3).velocity_mps.y(), TypeParam(2));
    EXPECT_LT(view(2).position_m.y(), view(3).position_m.y());
}

TYPED_TEST(DiscreteExtremes, leaves_infinite_masses_where_they_go) {
    Scene scene;
    scene.walls = Walls{{-5.0, -5.0}, {5.0, 5.0}};
    scene.bodies = {{{4.4, 0.0}, {1.0, 0.0}, 0.5, kInfinite},
                    {{4.2, 0.0}, {2.0, 0.0}, 0.5, kInfinite},
                    {{0.0, 0.0}, {0.0, 0.0}, 1.0, kInfinite},
                    {{0.0, 1.9}, {0.0, -3.0}, 1.0, 1.0}};
    World<TypeParam> world(scene, kDiscrete);
    world.step(TypeParam(0));
    ASSERT_EQ(world.contacts().size(), 1U);
    EXPECT_NEAR(static_cast<double>(world.contacts()[0].impulse_ns), 6.0, 1e-6);
    const auto view = [&](std::size_t i) { return world.body(world.ids()[i]); };
    EXPECT_NEAR(static_cast<double>(view(3).position_m.y()), 2.0, 1e-6);
    world.step(TypeParam(0.5));
    EXPECT_EQ(view(0).velocity_mps.x(), TypeParam(1)) << "passes through walls";
    EXPECT_EQ(view(1).velocity_mps.x(), TypeParam(2)) << "and its like";
    EXPECT_EQ(view(2).position_m.norm(), TypeParam(0));
    EXPECT_NEAR(static_cast<double>(view(3).velocity_mps.y()), 3.0, 1e-6);
}

TYPED_TEST(DiscreteExtremes, drops_whose_centre_is_off_at_the_end_of_a_substep) {
    const Platform platforms[] = {Disc{3.0}, Rectangle{{3.0, 4.0}}, Ring{0.5, 3.0}};
    for (const Platform& platform : platforms) {
        Scene scene;
        scene.platform = platform;
        scene.bodies = {{{2.8, 0.0}, {6.0, 0.0}, 0.4, 1.0}, {{-2.0, 0.0}, {0.0, 0.0}, 0.4, 1.0}};
        World<TypeParam> world(scene, {SolverKind::kDiscrete, 4});
        const BodyId first = world.ids()[0], second = world.ids()[1];
        const StepReport report = world.step(static_cast<TypeParam>(0.1));
        ASSERT_EQ(world.falls().size(), 1U);
        EXPECT_EQ(report.events, 1U);
        EXPECT_EQ(world.falls()[0].id, first);
        EXPECT_NEAR(static_cast<double>(world.falls()[0].time_s), 0.05, 1e-6);
        EXPECT_NEAR(static_cast<double>(world.falls()[0].position_m.x()), 3.1, 1e-6);
        EXPECT_FALSE(world.contains(first));
        EXPECT_TRUE(world.contains(second));
    }
}

TYPED_TEST(DiscreteExtremes, lets_balls_come_and_go) {
    constexpr std::uint64_t kSeed = 62;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene = random_gas({.balls = 40, .half_width_m = 8.0, .walled = false}, dice);
    scene.platform = Disc{12.0};
    World<TypeParam> world(scene, kDiscrete);
    std::size_t fallen = 0, added = 0;
    for (int tick = 0; tick < 600; ++tick) {
        if (world.add({dice.in_box(8.0), dice.in_box(5.0), 0.4, 1.0})) ++added;
        if (tick % 50 == 0) world.remove(world.ids()[0]);
        const std::size_t before = world.size();
        world.step(static_cast<TypeParam>(kTick));
        fallen += world.falls().size();
        ASSERT_EQ(world.size(), before - world.falls().size());
        ASSERT_TRUE(all_finite(world));
        for (const BodyId id : world.ids()) {
            ASSERT_LE(world.body(id).position_m.norm(), TypeParam(12.0001));
        }
    }
    EXPECT_GT(fallen, 50U);
    EXPECT_GT(added, 50U);
    EXPECT_GT(world.audit().ball_collisions, 100U);
}

TYPED_TEST(DiscreteExtremes, finds_a_pair_however_far_out_and_whatever_else_there_is) {
    for (const double far_m : {0.0, 1e3, 1e6, 1e8}) {
        SCOPED_TRACE(far_m);
        const double radius = std::max(1.0, 1e-5 * far_m);
        Scene scene;
        scene.bodies = {{{far_m, far_m}, {1.0, 0.0}, radius, 1.0},
                        {{far_m + 1.5 * radius, far_m}, {-1.0, 0.0}, radius, 1.0},
                        {{-1e9, -1e9}, {1e9, 1e9}, 1e-6, 1.0},
                        {{-1e9, 1e9}, {-1e9, 1e9}, 1e-6, 1e-9}};
        World<TypeParam> world(scene, kDiscrete);
        for (int tick = 0; tick < 100; ++tick) world.step(static_cast<TypeParam>(kTick));
        EXPECT_EQ(world.audit().ball_collisions, 1U);
        EXPECT_TRUE(all_finite(world));
    }
}

TYPED_TEST(DiscreteExtremes, finds_a_speck_on_a_giant) {
    Scene scene;
    scene.bodies = {{{0.0, 0.0}, {0.0, 0.0}, 1e4, 1e9},
                    {{1e4, 0.0}, {-1.0, 0.0}, 1.0, 1e-3},
                    {{0.0, -1e4}, {0.0, 1.0}, 1.0, 1e-3},
                    {{0.0, 2e4}, {0.0, 0.0}, 1.0, 1e-3}};
    World<TypeParam> world(scene, kDiscrete);
    world.step(static_cast<TypeParam>(1e-3));
    EXPECT_EQ(world.audit().ball_collisions, 2U);
    EXPECT_NEAR(static_cast<double>(world.body(world.ids()[1]).velocity_mps.x()), 1.0, 1e-6);
}

TYPED_TEST(DiscreteExtremes, keeps_everybody_within_walls_and_never_overruns) {
    constexpr std::uint64_t kSeed = 63;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene = random_gas({.balls = 80, .half_width_m = 6.0, .max_speed_mps = 2000.0}, dice);
    World<TypeParam> world(scene, kDiscrete);
    for (int tick = 0; tick < 200; ++tick) {
        const StepReport report = world.step(static_cast<TypeParam>(kTick));
        ASSERT_FALSE(report.overrun);
        ASSERT_EQ(report.unspent_time_s, 0.0);
        for (const BodyId id : world.ids()) {
            const auto body = world.body(id);
            const double reach = static_cast<double>(body.position_m.cwiseAbs().maxCoeff());
            ASSERT_LE(reach, 6.0 - static_cast<double>(body.radius_m) + 1e-6);
        }
    }
}

TEST(DeepestOverlap, is_that_of_the_worst_pair_or_wall_in_units_of_the_smaller_radius) {
    Model<double> model;
    model.walls = {Vec2d(-10.0, -10.0), Vec2d(10.0, 10.0)};
    Bodies<double> bodies;
    EXPECT_EQ(deepest_overlap(bodies, model), 0.0);
    bodies.add({0.0, 0.0}, {0.0, 0.0}, 1.0, 1.0);
    bodies.add({3.0, 0.0}, {0.0, 0.0}, 2.0, 1.0);
    EXPECT_EQ(deepest_overlap(bodies, model), 0.0) << "touching";
    bodies.position_m[1].x() = 2.5;
    EXPECT_NEAR(deepest_overlap(bodies, model), 0.5, 1e-15);
    bodies.add({9.8, 9.5}, {0.0, 0.0}, 0.5, kInfinite);
    bodies.add({9.9, 9.5}, {0.0, 0.0}, 0.5, kInfinite);
    EXPECT_NEAR(deepest_overlap(bodies, model), 0.5, 1e-15) << "these pass";
    bodies.add({-9.6, 5.0}, {0.0, 0.0}, 1.0, 1.0);
    EXPECT_NEAR(deepest_overlap(bodies, model), 0.6, 1e-14);
}

TEST(DeepestOverlap, sees_through_the_sides_of_a_periodic_box) {
    Scene scene;
    scene.periodic = Periodic{{0.0, 0.0}, {10.0, 10.0}};
    scene.bodies = {{{0.5, 9.5}, {0.0, 0.0}, 1.0, 1.0}, {{9.5, 0.5}, {0.0, 0.0}, 1.0, 1.0}};
    EXPECT_NEAR(World<double>(scene).deepest_overlap(), 2.0 - std::sqrt(2.0), 1e-14);
}

TEST(DeepestOverlap, is_what_looking_at_every_pair_finds) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        Scene scene;
        for (int i = 0; i < 50; ++i) {
            scene.bodies.push_back({dice.in_box(20.0), {0.0, 0.0}, 0.7, 1.0});
        }
        const World<double> world(scene);
        const double expected = std::max(0.0, deepest_penetration_m(world)) / 0.7;
        EXPECT_NEAR(world.deepest_overlap(), expected, 1e-13);
    }
}

}  // namespace
}  // namespace fts::physics
