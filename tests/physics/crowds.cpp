#include "tests/physics/crowds.h"

#include <cmath>
#include <numbers>

namespace fts::physics {

Scene random_crowd(const CrowdShape& shape, Dice& dice) {
    std::vector<double> radii;
    double area = 0.0;
    while (radii.size() < shape.balls) {
        const double radius = dice.between(shape.min_radius_m, shape.max_radius_m);
        area += std::numbers::pi * radius * radius;
        radii.push_back(radius);
    }
    const double half_width = 0.5 * std::sqrt(area / shape.filled);
    Scene scene;
    scene.walls = {shape.centre_m - Vec2d::Constant(half_width),
                   shape.centre_m + Vec2d::Constant(half_width)};
    for (const double radius : radii) {
        BodyDef ball{Vec2d::Zero(), dice.in_box(shape.max_speed_mps), radius, radius * radius};
        const auto is_clear = [&] {
            for (const BodyDef& other : scene.bodies) {
                const double reach = radius + other.radius_m;
                if ((ball.position_m - other.position_m).squaredNorm() < reach * reach) {
                    return false;
                }
            }
            return true;
        };
        do {
            ball.position_m = shape.centre_m + dice.in_box(half_width - radius);
        } while (!is_clear());
        scene.bodies.push_back(ball);
    }
    return scene;
}

std::vector<BodyDef> rack(int rows, double radius_m) {
    std::vector<BodyDef> balls;
    for (int row = 0; row < rows; ++row) {
        for (int i = 0; i <= row; ++i) {
            const double x = row * std::sqrt(3.0) * radius_m, y = (2 * i - row) * radius_m;
            balls.push_back({Vec2d(x, y), Vec2d::Zero(), radius_m, 1.0});
        }
    }
    return balls;
}

void stand_on(const Platform& platform, Scene& scene) {
    scene.platform = platform;
    std::erase_if(scene.bodies, [&](const BodyDef& body) {
        return distance_to_edge_m(platform, body.position_m) < 0.0;
    });
}

}  // namespace fts::physics
