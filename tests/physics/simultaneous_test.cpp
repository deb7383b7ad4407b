// Contacts of one instant: cradles, racks, wedges, and clusters at random, both alone and as the
// solver meets them.
#include "common/physics/simultaneous.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

// ---- Cradles in a world ----

// Balls of radius 1/2 that touch, in a row from x = 0; then `strikers` that touch each other and
// come from the left.
Scene cradle(const std::vector<double>& masses_kg, const std::vector<double>& strikers_kg,
             double speed_mps) {
    Scene scene;
    for (std::size_t i = 0; i < masses_kg.size(); ++i) {
        const auto x = static_cast<double>(i);
        scene.bodies.push_back({Vec2d(x, 0), Vec2d::Zero(), 0.5, masses_kg[i]});
    }
    for (std::size_t i = 0; i < strikers_kg.size(); ++i) {
        const double x = -3.0 - static_cast<double>(i);
        scene.bodies.push_back({Vec2d(x, 0), Vec2d(speed_mps, 0), 0.5, strikers_kg[i]});
    }
    return scene;
}

std::vector<double> speeds_left_to_right(const World<double>& world) {
    std::vector<std::pair<double, double>> sorted;
    for (const BodyId id : world.ids()) {
        sorted.push_back({world.body(id).position_m.x(), world.body(id).velocity_mps.x()});
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<double> speeds;
    for (const auto& [x, speed] : sorted) speeds.push_back(speed);
    return speeds;
}

void expect_row_keeps_order_and_parts(const World<double>& world) {
    const std::vector<double> speeds = speeds_left_to_right(world);
    for (std::size_t i = 1; i < speeds.size(); ++i) {
        EXPECT_GE(speeds[i] - speeds[i - 1], -1e-13) << "ball " << i;
    }
    EXPECT_LT(deepest_penetration_m(world), 1e-12);
}

class EqualCradle : public testing::TestWithParam<std::size_t> {};

TEST_P(EqualCradle, as_many_go_out_as_come_in) {
    const std::size_t in = GetParam();
    World<double> world(cradle(std::vector(7, 1.0), std::vector(in, 1.0), 2.0));
    ASSERT_FALSE(world.step(2.0).overrun);
    const std::vector<double> speeds = speeds_left_to_right(world);
    for (std::size_t i = 0; i < speeds.size(); ++i) {
        EXPECT_NEAR(speeds[i], i < speeds.size() - in ? 0.0 : 2.0, 1e-14) << i;
    }
    EXPECT_EQ(world.audit().unfinished_sets, 0U);
}

INSTANTIATE_TEST_SUITE_P(BallsIn, EqualCradle, testing::Values(1, 2, 3, 5));

TEST(Cradle, of_unequal_masses_conserves_and_parts) {
    for (std::uint64_t seed = 200; seed < 220; ++seed) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        std::vector<double> masses(2 + dice.below(10));
        for (double& mass : masses) mass = dice.of_any_size(1e-3, 1e3);
        World<double> world(cradle(masses, {dice.of_any_size(1e-3, 1e3)}, 2.0));
        const double energy = world.kinetic_energy_j();
        const Vec2d momentum = world.momentum_ns();
        ASSERT_FALSE(world.step(1.5).overrun);
        EXPECT_NEAR(world.kinetic_energy_j() / energy, 1.0, 1e-12);
        EXPECT_LT((world.momentum_ns() - momentum).norm(), 1e-12 * momentum.norm());
        EXPECT_GT(world.audit().ball_collisions, 1U);
        expect_row_keeps_order_and_parts(world);
    }
}

TEST(Cradle, a_heavy_ball_goes_on_behind_those_it_sends_out) {
    World<double> world(cradle(std::vector(5, 1.0), {10.0}, 2.0));
    ASSERT_FALSE(world.step(1.5).overrun);
    const std::vector<double> speeds = speeds_left_to_right(world);
    EXPECT_GT(speeds.front(), 0.0);
    EXPECT_GT(speeds.back(), 2.0);
    EXPECT_NEAR(world.kinetic_energy_j(), 20.0, 1e-12);
    EXPECT_NEAR(world.momentum_ns().x(), 20.0, 1e-12);
    expect_row_keeps_order_and_parts(world);
}

TEST(Cradle, struck_from_both_ends_at_once_is_symmetric) {
    Scene scene = cradle(std::vector(5, 1.0), {1.0}, 2.0);
    scene.bodies.push_back({Vec2d(7, 0), Vec2d(-2, 0), 0.5, 1.0});
    World<double> world(scene);
    ASSERT_FALSE(world.step(1.5).overrun);
    const std::vector<double> speeds = speeds_left_to_right(world);
    EXPECT_NEAR(speeds.front(), -2.0, 1e-14);
    EXPECT_NEAR(speeds.back(), 2.0, 1e-14);
    for (std::size_t i = 1; i + 1 < speeds.size(); ++i) EXPECT_NEAR(speeds[i], 0.0, 1e-14) << i;
}

TEST(Cradle, that_loses_energy_loses_it_in_the_first_hit_only) {
    Scene scene = cradle(std::vector(4, 1.0), {1.0}, 2.0);
    scene.restitution = 0.5;
    World<double> world(scene);
    ASSERT_FALSE(world.step(1.05).overrun);
    EXPECT_NEAR(world.momentum_ns().x(), 2.0, 1e-14);
    EXPECT_NEAR(world.kinetic_energy_j(), 0.5 * (1.5 * 1.5 + 0.5 * 0.5), 1e-13);
    EXPECT_NEAR(speeds_left_to_right(world).back(), 1.5, 1e-14);
    expect_row_keeps_order_and_parts(world);
}

TEST(Cradle, of_a_thousand_balls_sends_out_one_within_bounded_passes) {
    World<double> world(cradle(std::vector(1000, 1.0), {1.0}, 2.0));
    const StepReport report = world.step(2.0);
    EXPECT_FALSE(report.overrun);
    EXPECT_EQ(report.events, 1000U);
    EXPECT_EQ(world.audit().unfinished_sets, 0U);
    const std::vector<double> speeds = speeds_left_to_right(world);
    for (std::size_t i = 0; i + 1 < speeds.size(); ++i) ASSERT_NEAR(speeds[i], 0.0, 1e-12) << i;
    EXPECT_NEAR(speeds.back(), 2.0, 1e-12);
    EXPECT_NEAR(world.kinetic_energy_j(), 2.0, 2e-12);
    EXPECT_NEAR(world.momentum_ns().x(), 2.0, 2e-12);
}

// ---- Racks, wedges and corners in a world ----

// `rows` of touching balls, apex down at the origin, mirror symmetric in x to the last bit; the cue
// ball comes straight from below.
Scene rack(int rows, double cue_speed_mps) {
    Scene scene;
    for (int row = 0; row < rows; ++row) {
        for (int i = 0; i <= row; ++i) {
            const Vec2d place(i - 0.5 * row, row * std::sqrt(0.75));
            scene.bodies.push_back({place, Vec2d::Zero(), 0.5, 1.0});
        }
    }
    scene.bodies.push_back({Vec2d(0, -2), Vec2d(0, cue_speed_mps), 0.5, 1.0});
    return scene;
}

double worst_asymmetry_mps(const World<double>& world, int rows) {
    double worst = 0.0;
    std::uint32_t first = 0;
    for (int row = 0; row < rows; ++row) {
        const auto last = first + static_cast<std::uint32_t>(row);
        for (std::uint32_t i = first; i <= last; ++i) {
            const Vec2d left = world.body(world.ids()[i]).velocity_mps;
            const Vec2d right = world.body(world.ids()[first + last - i]).velocity_mps;
            worst = std::max(worst, (left - Vec2d(-right.x(), right.y())).norm());
        }
        first = last + 1;
    }
    return worst;
}

TEST(Rack, broken_head_on_stays_mirror_symmetric) {
    World<double> world(rack(5, 10.0));
    world.step(0.11);
    ASSERT_GT(world.audit().ball_collisions, 10U);
    EXPECT_LT(worst_asymmetry_mps(world, 5), 1e-12);
    for (int tick = 0; tick < 60; ++tick) {
        world.step(kTick);
        for (const Contact<double>& hit : world.contacts()) {
            EXPECT_GT(hit.impulse_ns, 1e-9) << "a pair that was parted hits again by round-off";
        }
    }
    EXPECT_LT(worst_asymmetry_mps(world, 5), 1e-9);
    EXPECT_NEAR(world.kinetic_energy_j(), 50.0, 1e-11);
    EXPECT_LT((world.momentum_ns() - Vec2d(0, 10)).norm(), 1e-12);
    EXPECT_LT(world.audit().worst_energy_error, 1e-13);
    EXPECT_EQ(world.audit().unfinished_sets, 0U);
}

TEST(Rack, of_any_size_conserves_and_parts) {
    for (int rows = 2; rows <= 12; ++rows) {
        SCOPED_TRACE(rows);
        World<double> world(rack(rows, 10.0));
        ASSERT_FALSE(world.step(0.11).overrun);
        EXPECT_NEAR(world.kinetic_energy_j(), 50.0, 1e-11);
        EXPECT_LT((world.momentum_ns() - Vec2d(0, 10)).norm(), 1e-12);
        for (int tick = 0; tick < 30; ++tick) ASSERT_FALSE(world.step(kTick).overrun);
        EXPECT_LT(deepest_penetration_m(world), 1e-12);
        EXPECT_NEAR(world.kinetic_energy_j(), 50.0, 1e-11);
    }
}

TEST(Rack, in_single_precision_conserves_and_parts) {
    for (int rows = 2; rows <= 12; ++rows) {
        SCOPED_TRACE(rows);
        World<float> world(rack(rows, 10.0));
        for (int tick = 0; tick < 40; ++tick) ASSERT_FALSE(world.step(1.0F / 60.0F).overrun);
        EXPECT_GT(world.audit().ball_collisions, 3U);
        EXPECT_NEAR(world.kinetic_energy_j(), 50.0, 1e-3);
        EXPECT_LT((world.momentum_ns() - Vec2d(0, 10)).norm(), 1e-4);
        EXPECT_LT(deepest_penetration_m(world), 1e-5F);
    }
}

TEST(Rack, a_hit_on_two_balls_at_once_is_as_on_paper) {
    // The balls go off along the lines of centres, 30 degrees from the way of the striker. With
    // equal masses v' of the striker is 2/5 v, and each gets 2 sqrt(3)/5 v.
    Scene scene;
    scene.bodies.push_back({Vec2d(0, -2), Vec2d(0, 5), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(-0.5, 0), Vec2d::Zero(), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(0.5, 0), Vec2d::Zero(), 0.5, 1.0});
    World<double> world(scene);
    world.step(1.0);
    ASSERT_EQ(world.contacts().size(), 2U);
    for (const Contact<double>& hit : world.contacts()) EXPECT_EQ(hit.contacts_at_once, 2U);
    const double speed = 2.0 * std::sqrt(3.0) / 5.0 * 5.0;
    const Vec2d right(speed * 0.5, speed * std::sqrt(0.75));
    EXPECT_LT((world.body(world.ids()[0]).velocity_mps - Vec2d(0, -1)).norm(), 1e-13);
    EXPECT_LT((world.body(world.ids()[1]).velocity_mps - Vec2d(-right.x(), right.y())).norm(),
              1e-13);
    EXPECT_LT((world.body(world.ids()[2]).velocity_mps - right).norm(), 1e-13);
    EXPECT_LT(world.audit().worst_energy_error, 1e-14);
    EXPECT_LT(world.audit().worst_momentum_error, 1e-14);
}

TEST(Wedge, of_two_touching_rocks_sends_a_ball_back_the_way_it_came) {
    Scene scene;
    scene.bodies.push_back({Vec2d(-1, 0), Vec2d::Zero(), 1.0, kInfinite});
    scene.bodies.push_back({Vec2d(1, 0), Vec2d::Zero(), 1.0, kInfinite});
    scene.bodies.push_back({Vec2d(0, 5), Vec2d(0, -3), 0.25, 1.0});
    World<double> world(scene);
    ASSERT_FALSE(world.step(3.0).overrun);
    EXPECT_EQ(world.contacts().size(), 2U);
    EXPECT_LT((world.body(world.ids()[2]).velocity_mps - Vec2d(0, 3)).norm(), 1e-13);
    EXPECT_LT(world.audit().worst_energy_error, 1e-14);
}

TEST(Wedge, thrown_at_askew_keeps_the_speed_and_lets_go) {
    for (std::uint64_t seed = 300; seed < 340; ++seed) {
        SCOPED_TRACE(seed);
        Dice dice(seed);
        Scene scene;
        scene.bodies.push_back({Vec2d(-1, 0), Vec2d::Zero(), 1.0, kInfinite});
        scene.bodies.push_back({Vec2d(1, 0), Vec2d::Zero(), 1.0, kInfinite});
        const double radius = dice.of_any_size(0.01, 10.0);
        const double height = std::sqrt((1.0 + radius) * (1.0 + radius) - 1.0);
        const Vec2d velocity(dice.between(-1.0, 1.0), dice.between(-3.0, -0.5));
        scene.bodies.push_back({Vec2d(0, height) - velocity, velocity, radius, 1.0});
        if (validate(scene)) continue;
        World<double> world(scene);
        ASSERT_FALSE(world.step(1.5).overrun);
        EXPECT_NEAR(world.body(world.ids()[2]).velocity_mps.norm() / velocity.norm(), 1.0, 1e-13);
        EXPECT_GT(world.body(world.ids()[2]).velocity_mps.y(), 0.0);
        EXPECT_LT(deepest_penetration_m(world), 1e-12);
    }
}

TEST(Corner, of_the_box_sends_a_ball_back_the_way_it_came) {
    Scene scene;
    scene.walls = Walls{Vec2d(-5, -5), Vec2d(5, 5)};
    scene.bodies.push_back({Vec2d(1.5, 1.5), Vec2d(3, 3), 0.5, 1.0});
    World<double> world(scene);
    world.step(1.5);
    EXPECT_EQ(world.body(world.ids()[0]).velocity_mps, Vec2d(-3, -3));
    EXPECT_EQ(world.audit().wall_collisions, 2U);
}

TEST(Corner, a_ball_resting_at_the_wall_passes_the_blow_to_it) {
    Scene scene;
    scene.walls = Walls{Vec2d(-5, -5), Vec2d(5, 5)};
    scene.bodies.push_back({Vec2d(4.5, 0), Vec2d::Zero(), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(0, 0), Vec2d(4, 0), 0.5, 1.0});
    World<double> world(scene);
    ASSERT_FALSE(world.step(1.0).overrun);
    // It comes back through the ball at rest, which stays at the wall.
    EXPECT_EQ(world.body(world.ids()[0]).velocity_mps, Vec2d(0, 0));
    EXPECT_EQ(world.body(world.ids()[1]).velocity_mps, Vec2d(-4, 0));
    EXPECT_EQ(world.audit().wall_collisions, 1U);
    EXPECT_EQ(world.audit().ball_collisions, 2U);
}

TEST(BetweenRocks, a_ball_with_no_room_is_an_overrun_and_keeps_its_energy) {
    Scene scene;
    scene.bodies.push_back({Vec2d(-1, 0), Vec2d::Zero(), 0.5, kInfinite});
    scene.bodies.push_back({Vec2d(0, 0), Vec2d(1, 0), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(1, 0), Vec2d::Zero(), 0.5, kInfinite});
    World<double> world(scene);
    EXPECT_TRUE(world.step(kTick).overrun);
    EXPECT_GT(world.audit().unfinished_sets, 0U);
    EXPECT_EQ(std::abs(world.body(world.ids()[1]).velocity_mps.x()), 1.0);
}

TEST(BetweenRocks, a_ball_struck_sideways_slides_out) {
    Scene scene;
    scene.bodies.push_back({Vec2d(-1, 0), Vec2d::Zero(), 0.5, kInfinite});
    scene.bodies.push_back({Vec2d(0, 0), Vec2d::Zero(), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(1, 0), Vec2d::Zero(), 0.5, kInfinite});
    scene.bodies.push_back({Vec2d(0, -3), Vec2d(0, 2), 0.5, 1.0});
    World<double> world(scene);
    ASSERT_FALSE(world.step(2.0).overrun);
    EXPECT_LT((world.body(world.ids()[1]).velocity_mps - Vec2d(0, 2)).norm(), 1e-14);
}

}  // namespace
}  // namespace fts::physics
