#include "common/replication/lattice_world.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace fts::replication {
namespace {

constexpr double kLeastRadiusM = kRadiusStepM;
constexpr double kLeastMassKg = kMassStepKg;

double fitting_radius_m(const BallState& ball, const physics::Scene& scene) {
    const double radius_m = std::max(kLeastRadiusM, ball.radius * kRadiusStepM);
    if (!scene.walls) return radius_m;
    const double width_m = (scene.walls->max_m - scene.walls->min_m).minCoeff();
    return std::min(radius_m, width_m / (2.0 + 2.0 * physics::kMinWallClearance));
}

// The step nearest to `value_m` that is not beyond the room between the walls, if there is one.
std::int32_t step_inside(double value_m, double step_m, double radius_m, double min_m,
                         double max_m) {
    const double low = std::ceil((min_m + radius_m) / step_m);
    const double high = std::floor((max_m - radius_m) / step_m);
    const double steps = std::round(value_m / step_m);
    return quantise(low > high ? steps : std::clamp(steps, low, high), 1.0);
}

physics::Vec2d place_inside(physics::Vec2d place_m, double radius_m, const physics::Scene& scene) {
    place_m = place_m.cwiseMin(physics::kMaxCoordinateM).cwiseMax(-physics::kMaxCoordinateM);
    if (!scene.walls) return place_m;
    const physics::Vec2d margin = physics::Vec2d::Constant(radius_m);
    return place_m.cwiseMin(scene.walls->max_m - margin).cwiseMax(scene.walls->min_m + margin);
}

}  // namespace

physics::Scene scene_of(const Course& course, std::span<const BallState> balls) {
    physics::Scene scene = course.scene;
    scene.bodies.clear();
    scene.bodies.reserve(balls.size());
    const Lattice& lattice = course.lattice;
    for (const BallState& ball : balls) {
        physics::BodyDef body;
        body.radius_m = fitting_radius_m(ball, scene);
        body.mass_kg = std::max(kLeastMassKg, ball.mass * kMassStepKg);
        body.position_m = place_inside({dequantise(ball.x, lattice.position_step_m),
                                        dequantise(ball.y, lattice.position_step_m)},
                                       body.radius_m, scene);
        body.velocity_mps = physics::Vec2d{dequantise(ball.vx, lattice.velocity_step_mps),
                                           dequantise(ball.vy, lattice.velocity_step_mps)}
                                .cwiseMin(physics::kMaxSpeedMps)
                                .cwiseMax(-physics::kMaxSpeedMps);
        scene.bodies.push_back(body);
    }
    return scene;
}

LatticeWorld::LatticeWorld(const Course& course, std::span<const BallState> balls)
    : course_(course), balls_(balls.begin(), balls.end()), world_(scene_of(course, balls)) {
    assert(!course_.scene.platform && !course_.scene.periodic);
    steer_all();
}

void LatticeWorld::steer_all() {
    if (!course_.control_of) return;
    for (std::size_t i = 0; i < balls_.size(); ++i) {
        const physics::Control<double> control = course_.control_of(balls_[i]);
        if (control.acts()) world_.set_control(world_.ids()[i], control);
    }
}

void LatticeWorld::steer(std::size_t index, const BallState& controls) {
    BallState& ball = balls_[index];
    ball.thrust_x = controls.thrust_x;
    ball.thrust_y = controls.thrust_y;
    ball.brake = controls.brake;
    if (course_.control_of) world_.set_control(world_.ids()[index], course_.control_of(ball));
}

void LatticeWorld::advance(double span_s) {
    world_.step(span_s);
}

void LatticeWorld::snap() {
    balls_ = balls();
    world_ = physics::World<double>(scene_of(course_, balls_));
    steer_all();
}

std::vector<BallState> LatticeWorld::balls() const {
    std::vector<BallState> all = balls_;
    const Lattice& lattice = course_.lattice;
    const auto& walls = course_.scene.walls;
    for (const physics::BodyId id : world_.ids()) {
        const physics::BodyView<double> body = world_.body(id);
        BallState& ball = all[id.index];
        ball.vx = quantise(body.velocity_mps.x(), lattice.velocity_step_mps);
        ball.vy = quantise(body.velocity_mps.y(), lattice.velocity_step_mps);
        if (walls) {
            ball.x = step_inside(body.position_m.x(), lattice.position_step_m, body.radius_m,
                                 walls->min_m.x(), walls->max_m.x());
            ball.y = step_inside(body.position_m.y(), lattice.position_step_m, body.radius_m,
                                 walls->min_m.y(), walls->max_m.y());
        } else {
            ball.x = quantise(body.position_m.x(), lattice.position_step_m);
            ball.y = quantise(body.position_m.y(), lattice.position_step_m);
        }
    }
    return all;
}

}  // namespace fts::replication
