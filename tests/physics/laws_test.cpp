// What must hold of every scene, whatever happens in it.
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "tests/physics/brute_force.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

constexpr std::uint64_t kTenThousand = 10'000;

TEST(Laws, a_walled_box_keeps_its_energy_over_ten_thousand_collisions) {
    for (const std::uint64_t seed : {1U, 2U}) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        World<double> world(
            random_gas({.balls = 24, .half_width_m = 6.0, .max_speed_mps = 40.0}, dice));
        const double energy = world.kinetic_energy_j();
        while (world.audit().ball_collisions < kTenThousand) {
            ASSERT_FALSE(world.step(kTick).overrun);
        }
        EXPECT_NEAR(world.kinetic_energy_j() / energy, 1.0, 1e-12);
        EXPECT_LT(world.audit().worst_energy_error, 1e-13);
        EXPECT_LT(world.audit().worst_momentum_error, 1e-14);
        EXPECT_LT(std::abs(world.audit().energy_change_j), 1e-12 * world.audit().energy_seen_j);
    }
}

TEST(Laws, a_free_scene_keeps_its_energy_and_momentum_over_ten_thousand_collisions) {
    constexpr std::uint64_t kSeed = 4;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    World<double> world(gas_in_a_ring_of_balls(30, dice));
    const double energy = world.kinetic_energy_j();
    const Vec2d momentum = world.momentum_ns();
    double speeds = 0.0;
    for (const BodyId id : world.ids()) {
        speeds += world.body(id).mass_kg * world.body(id).velocity_mps.norm();
    }
    while (world.audit().ball_collisions < kTenThousand) {
        ASSERT_FALSE(world.step(kTick).overrun);
    }
    EXPECT_NEAR(world.kinetic_energy_j() / energy, 1.0, 1e-12);
    EXPECT_LT((world.momentum_ns() - momentum).norm(), 1e-12 * speeds);
}

TEST(Laws, nothing_ever_overlaps) {
    constexpr std::uint64_t kSeed = 5;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    World<double> world(
        random_gas({.balls = 40, .half_width_m = 8.0, .max_speed_mps = 60.0}, dice));
    for (int tick = 0; tick < 150; ++tick) {
        world.step(kTick);
        ASSERT_LE(deepest_penetration_m(world), 1e-13);
        for (const Contact<double>& hit : world.contacts()) {
            if (!hit.b) continue;
            const double reach = world.body(hit.a).radius_m + world.body(*hit.b).radius_m;
            ASSERT_NEAR((hit.position_a_m - hit.position_b_m).norm(), reach, 1e-13);
        }
    }
    EXPECT_GT(world.audit().ball_collisions, 1000U);
}

TEST(Laws, at_a_thousand_metres_contacts_are_still_good_to_round_off) {
    constexpr std::uint64_t kSeed = 6;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene = random_gas({.balls = 40, .half_width_m = 8.0, .max_speed_mps = 60.0}, dice);
    for (BodyDef& body : scene.bodies) body.position_m += Vec2d(1000, -1000);
    scene.walls->min_m += Vec2d(1000, -1000);
    scene.walls->max_m += Vec2d(1000, -1000);
    World<double> world(scene);
    for (int tick = 0; tick < 150; ++tick) {
        world.step(kTick);
        ASSERT_LE(deepest_penetration_m(world), 1e-12);
    }
}

TEST(Laws, time_runs_back_to_where_it_came_from) {
    // Each collision multiplies round-off by about the free path over the radius: some dozens of
    // collisions a ball would leave nothing. The bound holds for the few that happen here.
    constexpr double kRecoveredM = 1e-8;
    for (const std::uint64_t seed : {7U, 8U, 9U}) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        const Scene scene = random_gas({.balls = 20, .half_width_m = 8.0}, dice);
        World<double> world(scene);
        for (int tick = 0; tick < 120; ++tick) world.step(kTick);
        const std::uint64_t hits = world.audit().ball_collisions + world.audit().wall_collisions;
        EXPECT_GT(hits, 20U);
        reverse(world);
        for (int tick = 0; tick < 120; ++tick) world.step(kTick);
        reverse(world);
        EXPECT_EQ(world.audit().ball_collisions + world.audit().wall_collisions, 2 * hits);
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            const BodyView<double> body = world.body(world.ids()[i]);
            EXPECT_LE((body.position_m - scene.bodies[i].position_m).norm(), kRecoveredM);
            EXPECT_LE((body.velocity_mps - scene.bodies[i].velocity_mps).norm(), kRecoveredM);
        }
    }
}

Vec2d mirrored(const Vec2d& v) {
    return {-v.x(), v.y()};
}

Scene mirrored(Scene scene) {
    for (BodyDef& body : scene.bodies) {
        body.position_m = mirrored(body.position_m);
        body.velocity_mps = mirrored(body.velocity_mps);
    }
    const Walls walls = *scene.walls;
    scene.walls->min_m.x() = -walls.max_m.x();
    scene.walls->max_m.x() = -walls.min_m.x();
    return scene;
}

TEST(Laws, a_mirrored_scene_moves_as_the_mirror_image_to_the_last_bit) {
    constexpr std::uint64_t kSeed = 10;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene = random_gas({.balls = 50, .max_speed_mps = 30.0}, dice);
    scene.walls->max_m.x() += 3.0;
    World<double> world(scene), mirror(mirrored(scene));
    for (const BodyId id : world.ids()) {
        const Vec2d thrust = dice.in_box(10.0);
        world.set_control(id, {thrust, 0.3});
        mirror.set_control(id, {mirrored(thrust), 0.3});
    }
    for (int tick = 0; tick < 600; ++tick) {
        world.step(kTick);
        mirror.step(kTick);
    }
    EXPECT_GT(world.audit().ball_collisions, 500U);
    for (const BodyId id : world.ids()) {
        EXPECT_EQ(world.body(id).position_m, mirrored(mirror.body(id).position_m));
        EXPECT_EQ(world.body(id).velocity_mps, mirrored(mirror.body(id).velocity_mps));
    }
}

TEST(Laws, where_the_scene_stands_does_not_matter) {
    constexpr std::uint64_t kSeed = 12;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    Scene scene = random_gas({.balls = 20, .half_width_m = 8.0, .walled = false}, dice);
    World<double> here(scene);
    for (BodyDef& body : scene.bodies) body.position_m += Vec2d(64, -128);
    World<double> there(scene);
    for (int tick = 0; tick < 120; ++tick) {
        here.step(kTick);
        there.step(kTick);
    }
    for (const BodyId id : here.ids()) {
        const Vec2d moved = there.body(id).position_m - Vec2d(64, -128);
        EXPECT_LE((here.body(id).position_m - moved).norm(), 1e-9);
    }
}

// Heavy ball, light ball, wall: with masses 100^n to 1 the number of collisions spells the digits
// of pi (Galperin, "Playing pool with pi", 2003). One collision missed or invented anywhere shows.
TEST(Laws, collisions_count_the_digits_of_pi) {
    std::uint64_t expected[] = {3, 31, 314, 3141};
    double heavy_kg = 1.0;
    for (const std::uint64_t digits : expected) {
        Scene scene;
        scene.walls = Walls{Vec2d(0, -5), Vec2d(1e6, 5)};
        scene.bodies.push_back({Vec2d(2, 0), Vec2d(0, 0), 0.5, 1.0});
        scene.bodies.push_back({Vec2d(5, 0), Vec2d(-1, 0), 0.5, heavy_kg});
        World<double> world(scene);
        ASSERT_FALSE(world.step(1000.0).overrun);
        EXPECT_EQ(world.audit().ball_collisions + world.audit().wall_collisions, digits);
        heavy_kg *= 100.0;
    }
}

void expect_same(const World<double>& world, const Outcome& oracle) {
    EXPECT_EQ(world.audit().ball_collisions, oracle.ball_collisions);
    EXPECT_EQ(world.audit().wall_collisions, oracle.wall_collisions);
    for (const BodyId id : world.ids()) {
        const BodyDef& expected = oracle.bodies[id.index];
        EXPECT_LE((world.body(id).position_m - expected.position_m).norm(), 1e-6) << id.index;
        EXPECT_LE((world.body(id).velocity_mps - expected.velocity_mps).norm(), 1e-6) << id.index;
    }
}

class AgainstBruteForce : public testing::TestWithParam<std::uint64_t> {};

TEST_P(AgainstBruteForce, a_walled_gas_moves_the_same) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    Gas gas;
    gas.balls = 2 + dice.below(60);
    gas.half_width_m = dice.between(10.0, 40.0);
    gas.min_radius_m = dice.of_any_size(0.01, 0.5);
    const Scene scene = random_gas(gas, dice);
    World<double> world(scene);
    world.step(1.5);
    expect_same(world, coast(scene, 1.5));
}

TEST_P(AgainstBruteForce, the_same_bodies_fall_from_each_platform) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    for (const Platform& platform :
         {Platform(Disc{15.0}), Platform(Rectangle{{11.0, 12.0}}), Platform(Ring{1.0, 15.0})}) {
        Scene scene = random_gas({.balls = 40, .walled = false}, dice);
        scene.platform = platform;
        std::erase_if(scene.bodies, [&](const BodyDef& body) {
            return distance_to_edge_m(platform, body.position_m) < 0.0;
        });
        World<double> world(scene);
        world.step(2.0);
        const Outcome oracle = coast(scene, 2.0);
        expect_same(world, oracle);
        ASSERT_EQ(world.falls().size(), oracle.fallen.size());
        EXPECT_GT(oracle.fallen.size(), 0U);
        for (std::size_t i = 0; i < oracle.fallen.size(); ++i) {
            EXPECT_EQ(world.falls()[i].id.index, oracle.fallen[i]);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, AgainstBruteForce, testing::Range<std::uint64_t>(100, 140));

}  // namespace
}  // namespace fts::physics
