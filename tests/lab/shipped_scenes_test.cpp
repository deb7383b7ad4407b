// The scenes that come with the program keep what their comments promise.
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "server/lab/scene_file.h"

namespace fts::lab {
namespace {

using physics::Vec2d;
using World = physics::World<double>;

World after(const std::string& name, double seconds) {
    const LoadedScene loaded = load_scene(name, FTS_SCENES_FOLDER);
    EXPECT_EQ(loaded.error, "");
    EXPECT_EQ(loaded.warning, "");
    World world(loaded.scene);
    const int ticks = static_cast<int>(std::lround(seconds * 60.0));
    for (int tick = 0; tick < ticks; ++tick) world.step(1.0 / 60.0);
    return world;
}

Vec2d velocity_of(const World& world, std::size_t body) {
    return world.body(world.ids()[body]).velocity_mps;
}

void expect_velocity(const World& world, std::size_t body, double x_mps, double y_mps = 0.0) {
    EXPECT_NEAR((velocity_of(world, body) - Vec2d(x_mps, y_mps)).norm(), 0.0, 1e-12) << body;
}

double degrees_of(const Vec2d& direction) {
    return std::atan2(direction.y(), direction.x()) * 180.0 / std::numbers::pi;
}

TEST(ShippedScenes, all_can_be_loaded) {
    const auto names = scene_names(FTS_SCENES_FOLDER);
    EXPECT_EQ(names.size(), 10U);
    for (const std::string& name : names) {
        const LoadedScene loaded = load_scene(name, FTS_SCENES_FOLDER);
        EXPECT_EQ(loaded.error, "");
        EXPECT_EQ(loaded.warning, "");
    }
}

TEST(ShippedScenes, head_on_swaps_velocities) {
    const World world = after("head-on", 4.0);
    EXPECT_EQ(world.audit().ball_collisions, 3U);
    expect_velocity(world, 0, 0.0);
    expect_velocity(world, 1, 1.0);
    expect_velocity(world, 2, -2.0);
    expect_velocity(world, 3, 1.0);
    expect_velocity(world, 4, 0.5);
    expect_velocity(world, 5, 1.5);
}

TEST(ShippedScenes, glancing_turns_the_shooter_by_little) {
    const World world = after("glancing", 3.0);
    EXPECT_NEAR(velocity_of(world, 1).norm(), 0.28, 1e-12);
    EXPECT_NEAR(velocity_of(world, 0).norm(), 0.96, 1e-12);
    EXPECT_NEAR(degrees_of(velocity_of(world, 0)), 16.26, 0.005);
}

TEST(ShippedScenes, right_angle_parts_at_a_right_angle) {
    const World world = after("right-angle", 4.0);
    const Vec2d shooter = velocity_of(world, 0), struck = velocity_of(world, 1);
    EXPECT_NEAR(shooter.norm(), 0.6, 1e-12);
    EXPECT_NEAR(struck.norm(), 0.8, 1e-12);
    EXPECT_NEAR(shooter.dot(struck), 0.0, 1e-12);
    EXPECT_NEAR(degrees_of(struck), -36.87, 0.005);
    EXPECT_NEAR(degrees_of(shooter), 53.13, 0.005);
}

TEST(ShippedScenes, heavy_light_throws_the_light_one_at_nearly_twice_the_speed) {
    const World world = after("heavy-light", 4.0);
    expect_velocity(world, 0, 99.0 / 101.0);
    expect_velocity(world, 1, 200.0 / 101.0);
    expect_velocity(world, 2, -99.0 / 101.0);
    expect_velocity(world, 3, 2.0 / 101.0);
}

TEST(ShippedScenes, criss_cross_collides_twice_at_any_speed) {
    const World world = after("criss-cross", 4.0);
    EXPECT_EQ(world.audit().ball_collisions, 2U);
    expect_velocity(world, 0, 1.0);
    expect_velocity(world, 1, 0.0, 1.0);
    expect_velocity(world, 2, 0.0, 1.0);
    expect_velocity(world, 3, 1.0, 0.0);
    expect_velocity(world, 4, 0.0, -400.0);
    expect_velocity(world, 5, 0.0, 400.0);
}

TEST(ShippedScenes, newtons_cradle_sends_only_the_last_ball) {
    const World world = after("newtons-cradle", 6.0);
    for (std::size_t body = 0; body < 5; ++body) expect_velocity(world, body, 0.0);
    expect_velocity(world, 5, 1.0);
}

TEST(ShippedScenes, rack_break_keeps_its_mirror_symmetry) {
    const World world = after("rack-break", 3.0);
    EXPECT_GT(world.audit().ball_collisions, 15U);
    EXPECT_NEAR(world.kinetic_energy_j(), 12.5, 1e-12);
    EXPECT_NEAR(velocity_of(world, 0).y(), 0.0, 1e-13);
    for (std::size_t row = 0, first = 1; row < 5; first += ++row) {
        for (std::size_t i = 0; i <= row; ++i) {
            const Vec2d here = velocity_of(world, first + i);
            const Vec2d there = velocity_of(world, first + row - i);
            EXPECT_NEAR((here - Vec2d(there.x(), -there.y())).norm(), 0.0, 1e-12);
        }
    }
}

TEST(ShippedScenes, gas_in_a_box_keeps_its_energy) {
    const World world = after("gas-in-a-box", 3.0);
    EXPECT_EQ(world.size(), 500U);
    EXPECT_GT(world.audit().ball_collisions, 500U);
    EXPECT_GT(world.audit().wall_collisions, 50U);
    EXPECT_NEAR(world.kinetic_energy_j(), 250.0, 250.0 * 1e-12);
}

TEST(ShippedScenes, periodic_gas_keeps_momentum_too_and_shares_energy_evenly) {
    const World world = after("periodic-gas", 15.0);
    EXPECT_LT(world.momentum_ns().norm(), 500.0 * 1e-12);
    double light_j = 0.0, heavy_j = 0.0;
    int light = 0, heavy = 0;
    for (const physics::BodyId id : world.ids()) {
        const auto body = world.body(id);
        const double energy_j = 0.5 * body.mass_kg * body.velocity_mps.squaredNorm();
        (body.radius_m < 0.4 ? light_j : heavy_j) += energy_j;
        ++(body.radius_m < 0.4 ? light : heavy);
    }
    EXPECT_NEAR((light_j / light) / (heavy_j / heavy), 1.0, 0.3);
}

TEST(ShippedScenes, pi_from_collisions_counts_3141) {
    const World world = after("pi-from-collisions", 20.0);
    EXPECT_EQ(world.audit().ball_collisions + world.audit().wall_collisions, 3141U);
}

}  // namespace
}  // namespace fts::lab
