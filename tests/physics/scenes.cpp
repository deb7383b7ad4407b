#include "tests/physics/scenes.h"

#include <cmath>
#include <numbers>

namespace fts::physics {
namespace {

bool is_clear(const Scene& scene, const BodyDef& ball) {
    for (const BodyDef& other : scene.bodies) {
        if ((ball.position_m - other.position_m).norm() < ball.radius_m + other.radius_m) {
            return false;
        }
    }
    return true;
}

}  // namespace

Scene random_gas(const Gas& gas, Dice& dice) {
    Scene scene;
    if (gas.walled) {
        scene.walls = {Vec2d::Constant(-gas.half_width_m), Vec2d::Constant(gas.half_width_m)};
    }
    while (scene.bodies.size() < gas.balls) {
        BodyDef ball;
        ball.radius_m = dice.between(gas.min_radius_m, gas.max_radius_m);
        ball.mass_kg = dice.between(0.5, 2.0);
        ball.position_m = dice.in_box(gas.half_width_m - ball.radius_m);
        ball.velocity_mps = dice.in_box(gas.max_speed_mps);
        if (is_clear(scene, ball)) scene.bodies.push_back(ball);
    }
    return scene;
}

Scene gas_in_a_ring_of_balls(std::size_t balls, Dice& dice) {
    constexpr int kFencePosts = 60;
    constexpr double kFenceRadiusM = 10.0;
    const double post_m = kFenceRadiusM * std::sin(std::numbers::pi / kFencePosts);
    Gas gas;
    gas.balls = balls;
    gas.half_width_m = 6.0;
    gas.walled = false;
    Scene scene = random_gas(gas, dice);
    for (int i = 0; i < kFencePosts; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kFencePosts;
        scene.bodies.push_back({kFenceRadiusM * Vec2d(std::cos(angle), std::sin(angle)),
                                Vec2d::Zero(), post_m * (1.0 - 1e-9), 1e6});
    }
    return scene;
}

}  // namespace fts::physics
