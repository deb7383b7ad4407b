#include "common/replication/lattice_world.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "common/game/rules.h"

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

// Rounding may have put a centre just beyond the edge; it falls in the next step then, as it would
// have. Whatever else is out there is brought back, too.
physics::Vec2d on_platform(const physics::Platform& platform, const physics::Vec2d& place_m) {
    if (physics::distance_to_edge_m(platform, place_m) >= 0.0) return place_m;
    constexpr double kLeastInsetM = 1e-6, kMostInsetM = 1e3;
    const physics::Vec2d edge_m = physics::nearest_edge_point_m(platform, place_m);
    const physics::Vec2d inward = edge_m - place_m;
    const double length_m = inward.norm();
    for (double inset_m = kLeastInsetM; length_m > 0.0 && inset_m < kMostInsetM; inset_m *= 4.0) {
        physics::Vec2d inside_m = edge_m + inward * (inset_m / length_m);
        if (physics::distance_to_edge_m(platform, inside_m) >= 0.0) return inside_m;
    }
    const auto* const ring = std::get_if<physics::Ring>(&platform);
    if (ring == nullptr) return physics::Vec2d::Zero();
    return {0.5 * (ring->inner_radius_m + ring->outer_radius_m), 0.0};
}

physics::Vec2d place_inside(physics::Vec2d place_m, double radius_m, const physics::Scene& scene) {
    place_m = place_m.cwiseMin(physics::kMaxCoordinateM).cwiseMax(-physics::kMaxCoordinateM);
    if (!scene.walls) return place_m;
    const physics::Vec2d margin = physics::Vec2d::Constant(radius_m);
    return place_m.cwiseMin(scene.walls->max_m - margin).cwiseMax(scene.walls->min_m + margin);
}

std::uint32_t steps(double value, double step) {
    constexpr double kGreatest = std::numeric_limits<std::uint32_t>::max();
    return static_cast<std::uint32_t>(std::clamp(std::round(value / step), 0.0, kGreatest));
}

physics::BodyDef body_of(const Course& course, const BallState& ball) {
    const Lattice& lattice = course.lattice;
    physics::BodyDef body;
    body.radius_m = fitting_radius_m(ball, course.scene);
    body.mass_kg = std::max(kLeastMassKg, ball.mass * kMassStepKg);
    body.position_m = place_inside(
        {dequantise(ball.x, lattice.position_step_m), dequantise(ball.y, lattice.position_step_m)},
        body.radius_m, course.scene);
    body.velocity_mps = physics::Vec2d{dequantise(ball.vx, lattice.velocity_step_mps),
                                       dequantise(ball.vy, lattice.velocity_step_mps)}
                            .cwiseMin(physics::kMaxSpeedMps)
                            .cwiseMax(-physics::kMaxSpeedMps);
    return body;
}

physics::BodyDef body_on_course(const Course& course, const BallState& ball) {
    physics::BodyDef body = body_of(course, ball);
    const auto& platform = course.scene.platform;
    if (platform) body.position_m = on_platform(*platform, body.position_m);
    return body;
}

using BodyOf = physics::BodyDef(const Course& course, const BallState& ball);

physics::Scene scene_with(const Course& course, std::span<const BallState> balls, BodyOf& body) {
    physics::Scene scene = course.scene;
    scene.bodies.clear();
    scene.bodies.reserve(balls.size());
    for (const BallState& ball : balls) scene.bodies.push_back(body(course, ball));
    return scene;
}

physics::Scene scene_on_course(const Course& course, std::span<const BallState> balls) {
    return scene_with(course, balls, body_on_course);
}

game::InputCommand held_by(const BallState& ball) {
    return {.thrust_x = ball.thrust_x, .thrust_y = ball.thrust_y, .brake = ball.brake};
}

}  // namespace

HandlingState quantised(const game::Handling& handling) {
    return {.acceleration = steps(handling.acceleration_mps2, kAccelerationStepMps2),
            .drag = steps(handling.drag_per_s, kDragStepPerS),
            .braking = steps(handling.braking_per_s, kDragStepPerS),
            .dash = steps(handling.dash_mps, kDashStepMps)};
}

game::Handling handling_of(const BallState& ball) {
    return {.acceleration_mps2 = ball.handling.acceleration * kAccelerationStepMps2,
            .drag_per_s = ball.handling.drag * kDragStepPerS,
            .braking_per_s = ball.handling.braking * kDragStepPerS,
            .dash_mps = ball.handling.dash * kDashStepMps};
}

Course course_of(const physics::Platform& platform, const physics::SolverChoice& solver) {
    Course course;
    course.scene.platform = platform;
    course.solver = solver;
    course.tick_s = game::kTickDurationS;
    course.control_of = [](const BallState& ball) {
        return game::control_for(handling_of(ball), held_by(ball));
    };
    course.dash_of = [](const BallState& ball) {
        return game::dash_for(handling_of(ball), held_by(ball));
    };
    return course;
}

physics::Scene scene_of(const Course& course, std::span<const BallState> balls) {
    return scene_with(course, balls, body_of);
}

LatticeWorld::LatticeWorld(const Course& course, std::span<const BallState> balls)
    : course_(course),
      balls_(balls.begin(), balls.end()),
      world_(scene_on_course(course, balls), course.solver) {
    assert(!course_.scene.periodic);
    list_all();
}

// A world that was just made has its bodies in the slots that their balls have.
void LatticeWorld::list_all() {
    entries_.clear();
    entries_.reserve(balls_.size());
    for (std::size_t slot = 0; slot < balls_.size(); ++slot) {
        entries_.push_back({balls_[slot].id, world_.ids()[slot]});
        if (!course_.control_of) continue;
        const physics::Control<double> control = course_.control_of(balls_[slot]);
        if (control.acts()) world_.set_control(entries_.back().body, control);
    }
}

std::vector<LatticeWorld::Entry>::const_iterator LatticeWorld::find(std::uint16_t id) const {
    return std::lower_bound(
        entries_.begin(), entries_.end(), id,
        [](const Entry& entry, std::uint16_t wanted) { return entry.id < wanted; });
}

std::optional<std::size_t> LatticeWorld::slot_of(std::uint16_t id) const {
    const auto entry = find(id);
    if (entry == entries_.end() || entry->id != id) return std::nullopt;
    return entry->body.index;
}

physics::BodyView<double> LatticeWorld::body(std::uint16_t id) const {
    const auto entry = find(id);
    assert(entry != entries_.end() && entry->id == id);
    return world_.body(entry->body);
}

void LatticeWorld::steer(std::size_t slot, const BallState& controls) {
    BallState& ball = balls_[slot];
    ball.thrust_x = controls.thrust_x;
    ball.thrust_y = controls.thrust_y;
    ball.brake = controls.brake;
    if (course_.control_of) world_.set_control(find(ball.id)->body, course_.control_of(ball));
}

void LatticeWorld::dash(std::size_t slot) {
    if (!course_.dash_of) return;
    const physics::BodyId body = find(balls_[slot].id)->body;
    world_.set_velocity(body, world_.body(body).velocity_mps + course_.dash_of(balls_[slot]));
}

bool LatticeWorld::put(const BallState& ball) {
    const auto place = find(ball.id);
    if (place != entries_.end() && place->id == ball.id) {
        BallState& held = balls_[place->body.index];
        held.mass = ball.mass;
        held.handling = ball.handling;
        world_.set_mass(place->body, body_of(course_, ball).mass_kg);
        if (course_.control_of) world_.set_control(place->body, course_.control_of(held));
        return true;
    }
    const auto body = world_.add(body_on_course(course_, ball));
    if (!body) return false;
    if (balls_.size() <= body->index) balls_.resize(body->index + 1);
    balls_[body->index] = ball;
    entries_.insert(place, {ball.id, *body});
    if (course_.control_of) world_.set_control(*body, course_.control_of(ball));
    return true;
}

void LatticeWorld::remove(std::uint16_t id) {
    const auto entry = find(id);
    if (entry == entries_.end() || entry->id != id) return;
    world_.remove(entry->body);
    entries_.erase(entry);
}

void LatticeWorld::halt() {
    for (const Entry& entry : entries_) {
        world_.set_velocity(entry.body, physics::Vec2d::Zero());
        steer(entry.body.index, {});
    }
}

physics::StepReport LatticeWorld::advance(double span_s) {
    const physics::StepReport report = world_.step(span_s);
    for (const physics::Fall<double>& fall : world_.falls()) {
        entries_.erase(find(balls_[fall.id.index].id));
    }
    return report;
}

void LatticeWorld::snap() {
    balls_ = balls();
    world_ = physics::World<double>(scene_on_course(course_, balls_), course_.solver);
    list_all();
}

std::vector<BallState> LatticeWorld::balls() const {
    std::vector<BallState> all;
    all.reserve(entries_.size());
    const Lattice& lattice = course_.lattice;
    const auto& walls = course_.scene.walls;
    for (const Entry& entry : entries_) {
        const physics::BodyView<double> body = world_.body(entry.body);
        BallState& ball = all.emplace_back(balls_[entry.body.index]);
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
