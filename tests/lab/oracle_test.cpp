// The oracle is believed because it gives what can be worked out on paper, keeps what is conserved
// to the last of its digits, and finds its way back through hundreds of collisions.
#include "server/lab/oracle.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/physics/generator.h"
#include "common/physics/world.h"
#include "tests/physics/scenes.h"

namespace fts::lab {
namespace {

using physics::BodyDef;
using physics::Dice;
using physics::Scene;
using physics::Vec2d;

constexpr double kInf = std::numeric_limits<double>::infinity();

Scene gas(std::size_t balls, bool walled, std::uint64_t seed) {
    Dice dice(seed);
    return physics::random_gas({.balls = balls, .half_width_m = 8.0, .walled = walled}, dice);
}

Scene periodic_gas(std::size_t balls, std::uint64_t seed) {
    Scene scene = gas(balls, true, seed);
    scene.periodic = physics::Periodic{scene.walls->min_m, scene.walls->max_m};
    scene.walls.reset();
    return scene;
}

double farthest_apart(const std::vector<BodyDef>& bodies, const std::vector<BodyDef>& others) {
    double farthest = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        farthest = std::max({farthest, (bodies[i].position_m - others[i].position_m).norm(),
                             (bodies[i].velocity_mps - others[i].velocity_mps).norm()});
    }
    return farthest;
}

TEST(Oracle, two_balls_meet_when_and_part_as_on_paper) {
    Scene scene;
    scene.bodies = {{{-2.0, 0.6}, {1.0, 0.0}, 0.5, 1.0}, {{0.0, 0.0}, {0.0, 0.0}, 0.5, 1.0}};
    Oracle oracle(scene);
    ASSERT_TRUE(oracle.advance(3.0));
    ASSERT_EQ(oracle.contacts().size(), 1U);
    const OracleContact& hit = oracle.contacts().front();
    EXPECT_DOUBLE_EQ(hit.time_s, 1.2);
    EXPECT_NEAR((hit.normal - Vec2d(-0.8, 0.6)).norm(), 0.0, 1e-15);
    EXPECT_NEAR((hit.velocity_b_after_mps - Vec2d(0.64, -0.48)).norm(), 0.0, 1e-15);
    EXPECT_NEAR((hit.velocity_a_after_mps - Vec2d(0.36, 0.48)).norm(), 0.0, 1e-15);
    EXPECT_NEAR((oracle.bodies()[1].position_m - 1.8 * Vec2d(0.64, -0.48)).norm(), 0.0, 1e-15);
}

TEST(Oracle, walls_and_infinite_masses_turn_a_ball_round) {
    Scene scene;
    scene.walls = physics::Walls{{0.0, 0.0}, {10.0, 10.0}};
    scene.bodies = {{{5.0, 5.0}, {2.0, 0.0}, 0.5, 1.0}, {{2.0, 5.0}, {0.0, 0.0}, 0.5, kInf}};
    Oracle oracle(scene);
    ASSERT_TRUE(oracle.advance(6.0));
    EXPECT_EQ(oracle.wall_collisions(), 1U);
    EXPECT_EQ(oracle.ball_collisions(), 1U);
    EXPECT_EQ(oracle.bodies()[0].velocity_mps, Vec2d(2.0, 0.0));
    EXPECT_EQ(oracle.energy_error(), 0.0);
    EXPECT_EQ(oracle.momentum_error(), 0.0);
}

TEST(Oracle, a_moving_infinite_mass_gives_energy_that_is_accounted_for) {
    Scene scene;
    scene.bodies = {{{0.0, 0.0}, {0.0, 0.3}, 0.5, 1.0}, {{-3.0, 0.2}, {2.0, 0.0}, 0.5, kInf}};
    Oracle oracle(scene);
    ASSERT_TRUE(oracle.advance(4.0));
    EXPECT_EQ(oracle.ball_collisions(), 1U);
    EXPECT_GT(oracle.bodies()[0].velocity_mps.x(), 2.0);
    EXPECT_LT(oracle.energy_error(), 1e-30);
    EXPECT_LT(oracle.momentum_error(), 1e-30);
}

TEST(Oracle, one_ball_into_a_cradle_sends_one_out_and_two_send_two) {
    for (const int movers : {1, 2}) {
        SCOPED_TRACE(movers);
        Scene scene;
        for (int i = 0; i < movers; ++i) {
            scene.bodies.push_back({{-3.0 + i, 0.0}, {1.0, 0.0}, 0.5, 1.0});
        }
        for (int i = 0; i < 5; ++i) scene.bodies.push_back({{1.0 + i, 0.0}, {0.0, 0.0}, 0.5, 1.0});
        Oracle oracle(scene);
        ASSERT_TRUE(oracle.advance(10.0));
        const auto bodies = oracle.bodies();
        const std::size_t last_at_rest = bodies.size() - static_cast<std::size_t>(movers);
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            EXPECT_EQ(bodies[i].velocity_mps.x(), i < last_at_rest ? 0.0 : 1.0) << i;
        }
    }
}

TEST(Oracle, breaks_a_rack_into_mirror_images) {
    Scene scene;
    scene.bodies.push_back({{-4.0, 0.0}, {5.0, 0.0}, 0.5, 1.0});
    for (int row = 0; row < 4; ++row) {
        for (int i = 0; i <= row; ++i) {
            scene.bodies.push_back(
                {{row * std::sqrt(3.0) / 2.0, i - row / 2.0}, {0.0, 0.0}, 0.5, 1.0});
        }
    }
    Oracle oracle(scene);
    ASSERT_TRUE(oracle.advance(3.0));
    EXPECT_GT(oracle.ball_collisions(), 10U);
    EXPECT_LT(oracle.energy_error(), 1e-30);
    EXPECT_LT(oracle.momentum_error(), 1e-30);
    const auto bodies = oracle.bodies();
    for (std::size_t row = 0, first = 1; row < 4; first += ++row) {
        for (std::size_t i = 0; i <= row; ++i) {
            const Vec2d& here = bodies[first + i].position_m;
            const Vec2d& there = bodies[first + row - i].position_m;
            EXPECT_NEAR((here - Vec2d(there.x(), -there.y())).norm(), 0.0, 1e-14);
        }
    }
}

TEST(Oracle, keeps_energy_and_momentum_to_thirty_digits) {
    constexpr std::uint64_t kSeed = 5;
    SCOPED_TRACE(kSeed);
    for (const Scene& scene : {gas(30, true, kSeed), periodic_gas(30, kSeed)}) {
        Oracle oracle(scene);
        ASSERT_TRUE(oracle.advance(8.0));
        EXPECT_GT(oracle.ball_collisions(), 100U);
        EXPECT_LT(oracle.energy_error(), 1e-30);
        EXPECT_LT(oracle.momentum_error(), 1e-30);
    }
}

TEST(Oracle, finds_its_way_back_through_three_hundred_collisions) {
    constexpr std::uint64_t kSeed = 8;
    SCOPED_TRACE(kSeed);
    for (const bool periodic : {false, true}) {
        Scene boundary;
        if (periodic) boundary.periodic = physics::Periodic{};
        // Dense and of many balls: the fewer collisions each ball has, and the shorter the ways
        // between them, the less is lost of the 34 digits.
        const auto made =
            physics::fill(boundary, {.seed = kSeed, .count = 100, .packing_fraction = 0.5});
        ASSERT_TRUE(std::holds_alternative<Scene>(made));
        Oracle oracle(std::get<Scene>(made));
        const auto start = oracle.bodies();
        double span_s = 0.0;
        while (oracle.ball_collisions() + oracle.wall_collisions() < 300) {
            ASSERT_TRUE(oracle.advance(0.5));
            span_s += 0.5;
        }
        const std::size_t there = oracle.ball_collisions();
        oracle.reverse();
        ASSERT_TRUE(oracle.advance(span_s));
        oracle.reverse();
        EXPECT_EQ(oracle.ball_collisions(), 2 * there);
        EXPECT_LT(farthest_apart(oracle.bodies(), start), 1e-15);
    }
}

TEST(Oracle, agrees_with_the_swept_solver_for_a_short_while) {
    constexpr std::uint64_t kSeed = 13;
    SCOPED_TRACE(kSeed);
    for (const Scene& scene : {gas(40, true, kSeed), gas(40, false, kSeed)}) {
        Oracle oracle(scene);
        physics::World<double> world(scene);
        for (int tick = 0; tick < 30; ++tick) {
            ASSERT_TRUE(oracle.advance(1.0 / 60.0));
            world.step(1.0 / 60.0);
            ASSERT_EQ(oracle.contacts().size(), world.contacts().size()) << tick;
        }
        EXPECT_GT(oracle.ball_collisions(), 10U);
        EXPECT_EQ(oracle.ball_collisions(), world.audit().ball_collisions);
        EXPECT_EQ(oracle.wall_collisions(), world.audit().wall_collisions);
        std::vector<BodyDef> bodies = oracle.bodies();
        for (const physics::BodyId id : world.ids()) {
            const auto body = world.body(id);
            EXPECT_NEAR((body.position_m - bodies[id.index].position_m).norm(), 0.0, 1e-10);
            EXPECT_NEAR((body.velocity_mps - bodies[id.index].velocity_mps).norm(), 0.0, 1e-9);
        }
    }
}

// Ten short advances meet what one long one meets, at the same times.
TEST(Oracle, does_not_care_how_time_is_cut) {
    constexpr std::uint64_t kSeed = 3;
    SCOPED_TRACE(kSeed);
    Scene scene = periodic_gas(30, kSeed);
    scene.drag_per_s = 0.3;
    Oracle whole(scene), cut(scene);
    ASSERT_TRUE(whole.advance(1.0));
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(cut.advance(0.1));
    EXPECT_GT(whole.ball_collisions(), 10U);
    EXPECT_EQ(whole.ball_collisions(), cut.ball_collisions());
    EXPECT_LT(farthest_apart(whole.bodies(), cut.bodies()), 1e-12);
}

TEST(Oracle, drag_slows_as_an_exponential_does) {
    Scene scene;
    scene.bodies = {{{0.0, 0.0}, {3.0, 0.0}, 0.5, 1.0}, {{2.0, 0.0}, {0.0, 0.0}, 0.5, 1.0}};
    scene.drag_per_s = 0.5;
    Oracle oracle(scene);
    ASSERT_TRUE(oracle.advance(4.0));
    ASSERT_EQ(oracle.contacts().size(), 1U);
    EXPECT_NEAR(oracle.contacts()[0].time_s, -std::log1p(-0.5 * 1.0 / 3.0) / 0.5, 1e-15);
    EXPECT_NEAR(oracle.contacts()[0].velocity_b_after_mps.x(), 3.0 * (1.0 - 0.5 / 3.0), 1e-15);
    EXPECT_NEAR(oracle.bodies()[1].velocity_mps.x(), 3.0 * std::exp(-2.0), 1e-15);
    EXPECT_EQ(oracle.energy_error(), 0.0);
}

TEST(Oracle, counts_the_digits_of_pi) {
    const std::size_t expected[] = {3, 31, 314, 3141};
    double mass_kg = 1.0;
    for (const std::size_t digits : expected) {
        Scene scene;
        scene.walls = physics::Walls{{0.0, -5.0}, {1e9, 5.0}};
        scene.bodies = {{{2.0, 0.0}, {0.0, 0.0}, 0.5, 1.0},
                        {{4.0, 0.0}, {-1.0, 0.0}, 0.5, mass_kg}};
        Oracle oracle(scene);
        ASSERT_TRUE(oracle.advance(1000.0));
        EXPECT_EQ(oracle.ball_collisions() + oracle.wall_collisions(), digits);
        mass_kg *= 100.0;
    }
}

TEST(Oracle, stops_after_as_many_events_as_it_may) {
    Oracle oracle(gas(30, true, 1));
    EXPECT_FALSE(oracle.advance(10.0, 20));
    EXPECT_EQ(oracle.ball_collisions() + oracle.wall_collisions(), 20U);
}

TEST(Oracle, balls_that_start_inside_each_other_part_and_coincident_ones_are_let_be) {
    Scene scene;
    scene.bodies = {{{0.0, 0.0}, {1.0, 0.0}, 0.5, 1.0},
                    {{0.4, 0.0}, {-1.0, 0.0}, 0.5, 1.0},
                    {{5.0, 0.0}, {1.0, 0.0}, 0.5, 1.0},
                    {{5.0, 0.0}, {-1.0, 0.0}, 0.5, 1.0}};
    Oracle oracle(scene);
    ASSERT_TRUE(oracle.advance(1.0));
    EXPECT_EQ(oracle.ball_collisions(), 1U);
    EXPECT_EQ(oracle.bodies()[0].velocity_mps.x(), -1.0);
}

}  // namespace
}  // namespace fts::lab
