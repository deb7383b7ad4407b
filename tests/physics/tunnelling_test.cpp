// Nothing passes through anything, however fast it is.
#include <cmath>

#include <gtest/gtest.h>

#include "common/physics/world.h"
#include "tests/physics/scenes.h"

namespace fts::physics {
namespace {

constexpr double kRadiusM = 0.5;

// In radii a tick, both balls together.
constexpr double kClosingSpeeds[] = {1e-2, 1e-1, 1.0, 3.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6};

struct Shot {
    Contact<double> hit;
    Vec2d velocity_1_mps, velocity_2_mps;
};

// Two equal balls flying at each other, the second one `aside_m` off the line; they meet within the
// tick.
std::optional<Shot> shoot(double closing_radii_per_tick, double aside_m) {
    const double speed = 0.5 * closing_radii_per_tick * kRadiusM / kTick;
    const double touching =
        std::sqrt(std::max(0.0, kRadiusM * kRadiusM - 0.25 * aside_m * aside_m));
    const double half_gap = touching + 0.4 * speed * kTick;
    Scene scene;
    scene.bodies.push_back({Vec2d(-half_gap, 0), Vec2d(speed, 0), kRadiusM, 1.0});
    scene.bodies.push_back({Vec2d(half_gap, aside_m), Vec2d(-speed, 0), kRadiusM, 1.0});
    World<double> world(scene);
    world.step(kTick);
    if (world.contacts().size() != 1) return std::nullopt;
    return Shot{world.contacts()[0], world.body(world.ids()[0]).velocity_mps,
                world.body(world.ids()[1]).velocity_mps};
}

TEST(Tunnelling, no_closing_speed_gets_two_balls_through_each_other) {
    for (const double closing : kClosingSpeeds) {
        SCOPED_TRACE(closing);
        const auto shot = shoot(closing, 0.0);
        ASSERT_TRUE(shot);
        EXPECT_NEAR(shot->hit.time_s / kTick, 0.4, 1e-9);
        EXPECT_LT(shot->velocity_1_mps.x(), 0.0);
        EXPECT_GT(shot->velocity_2_mps.x(), 0.0);
        const double distance = (shot->hit.position_a_m - shot->hit.position_b_m).norm();
        EXPECT_NEAR(distance, 2.0 * kRadiusM, 1e-12 * std::max(1.0, 1e-3 * closing));
    }
}

TEST(Tunnelling, even_a_grazing_shot_hits_at_every_speed) {
    for (const double closing : kClosingSpeeds) {
        for (const double aside : {0.5, 0.9, 0.99, 0.999, 0.9999}) {
            SCOPED_TRACE(closing);
            const auto shot = shoot(closing, aside * 2.0 * kRadiusM);
            ASSERT_TRUE(shot) << aside;
            EXPECT_NEAR(std::abs(shot->hit.normal.y()), aside, 1e-6) << "deflected elsewhere";
        }
    }
}

TEST(Tunnelling, a_shot_that_passes_wide_misses_at_every_speed) {
    for (const double closing : kClosingSpeeds) {
        EXPECT_FALSE(shoot(closing, 1.0001 * 2.0 * kRadiusM)) << closing;
    }
}

TEST(Tunnelling, no_speed_gets_a_ball_through_a_wall) {
    for (const double radii_per_tick : kClosingSpeeds) {
        SCOPED_TRACE(radii_per_tick);
        const double speed = radii_per_tick * kRadiusM / kTick;
        const double room = std::max(4.0, 0.4 * speed * kTick);
        Scene scene;
        scene.walls = Walls{Vec2d(-room, -5), Vec2d(room, 5)};
        scene.bodies.push_back({Vec2d(0, 0), Vec2d(speed, 0), kRadiusM, 1.0});
        World<double> world(scene);
        for (int tick = 0; tick < 100; ++tick) {
            ASSERT_FALSE(world.step(kTick).overrun);
            const BodyView<double> ball = world.body(world.ids()[0]);
            ASSERT_LE(std::abs(ball.position_m.x()), (room - kRadiusM) * (1.0 + 1e-15));
            ASSERT_EQ(std::abs(ball.velocity_mps.x()), speed);
        }
    }
}

TEST(Tunnelling, a_bullet_hits_the_one_ball_among_hundreds_on_its_way) {
    Scene scene;
    for (int x = 0; x < 20; ++x) {
        for (int y = 0; y < 20; ++y) {
            if (y != 10) scene.bodies.push_back({Vec2d(3 * x, 3 * y), Vec2d::Zero(), 0.5, 1.0});
        }
    }
    scene.bodies.push_back({Vec2d(1e4, 30), Vec2d::Zero(), 0.5, 1.0});
    scene.bodies.push_back({Vec2d(-1e4, 30), Vec2d(6e6, 0), 0.5, 1.0});
    World<double> world(scene);
    EXPECT_EQ(world.step(kTick).events, 1U);
    EXPECT_EQ(world.body(world.ids()[399 - 19]).velocity_mps, Vec2d(6e6, 0));
}

TEST(Tunnelling, single_precision_does_not_let_through_either) {
    for (const double closing : kClosingSpeeds) {
        SCOPED_TRACE(closing);
        const double speed = (closing + 0.05) * kRadiusM / kTick;
        Scene scene;
        scene.bodies.push_back({Vec2d(-1.0 - 0.5 * speed * kTick, 0), Vec2d(speed, 0), 0.5, 1.0});
        scene.bodies.push_back({Vec2d(0, 0.1), Vec2d(0, 0), 0.5, 1.0});
        World<float> world(scene);
        EXPECT_EQ(world.step(static_cast<float>(kTick)).events, 1U);
    }
}

}  // namespace
}  // namespace fts::physics
