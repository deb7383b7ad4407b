#include "server/lab/arena_trace.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "common/game/input.h"
#include "common/physics/exponential.h"
#include "common/physics/generator.h"

namespace fts::lab {
namespace {

using replication::BallState;

struct Direction {
    std::int8_t x, y;
};
constexpr std::array<Direction, 9> kDirections{
    {{0, 0}, {127, 0}, {90, 90}, {0, 127}, {-90, 90}, {-127, 0}, {-90, -90}, {0, -127}, {90, -90}}};

physics::Control<double> control_of(const BallState& ball) {
    physics::Control<double> control;
    if (ball.kind != static_cast<std::uint8_t>(replication::BallKind::kPlayer)) return control;
    control.acceleration_mps2 =
        kTraceThrustMps2 * game::thrust_of({.thrust_x = ball.thrust_x, .thrust_y = ball.thrust_y});
    control.drag_per_s = kTraceDragPerS;
    return control;
}

void choose_steered(std::vector<BallState>& balls, std::uint64_t seed) {
    physics::SplitMix random(seed);
    auto left =
        static_cast<std::size_t>(std::round(kTraceSteeredPart * static_cast<double>(balls.size())));
    for (std::size_t i = 0; i < balls.size(); ++i) {
        if (random.below(balls.size() - i) >= left) continue;
        balls[i].kind = static_cast<std::uint8_t>(replication::BallKind::kPlayer);
        --left;
    }
}

}  // namespace

double trace_radius_m(std::size_t count) {
    const double area_m2 = kTraceCoverage * kTraceWidthM * kTraceHeightM;
    const double radius_m = std::sqrt(area_m2 / (static_cast<double>(count) * std::numbers::pi));
    return std::max(1.0, std::round(radius_m / replication::kRadiusStepM)) *
           replication::kRadiusStepM;
}

replication::Course trace_course() {
    replication::Course course;
    course.scene.walls = physics::Walls{{0.0, 0.0}, {kTraceWidthM, kTraceHeightM}};
    course.lattice = kTraceLattice;
    course.tick_s = 1.0 / kTraceTickRateHz;
    course.control_of = control_of;
    return course;
}

std::optional<ArenaTrace> ArenaTrace::make(std::size_t count, std::uint64_t seed,
                                           replication::Tick snapshot_ticks, bool snaps,
                                           std::string& error) {
    physics::Generator generator;
    generator.seed = seed;
    generator.count = static_cast<std::int64_t>(count);
    generator.radius_min_m = generator.radius_max_m = trace_radius_m(count);
    generator.speed_rms_mps = kTraceRmsSpeedMps;
    auto filled = physics::fill(trace_course().scene, generator);
    if (const auto* refused = std::get_if<physics::SceneError>(&filled)) {
        error = refused->message;
        return std::nullopt;
    }
    std::vector<BallState> balls;
    for (const physics::BodyDef& body : std::get<physics::Scene>(filled).bodies) {
        BallState ball;
        ball.id = static_cast<std::uint16_t>(balls.size());
        ball.x = replication::quantise(body.position_m.x(), kTraceLattice.position_step_m);
        ball.y = replication::quantise(body.position_m.y(), kTraceLattice.position_step_m);
        ball.vx = replication::quantise(body.velocity_mps.x(), kTraceLattice.velocity_step_mps);
        ball.vy = replication::quantise(body.velocity_mps.y(), kTraceLattice.velocity_step_mps);
        ball.radius = static_cast<std::uint16_t>(body.radius_m / replication::kRadiusStepM);
        ball.mass = static_cast<std::uint32_t>(1.0 / replication::kMassStepKg);
        balls.push_back(ball);
    }
    choose_steered(balls, seed);
    return ArenaTrace(std::move(balls), seed, snapshot_ticks, snaps);
}

ArenaTrace::ArenaTrace(std::vector<BallState> balls, std::uint64_t seed,
                       replication::Tick snapshot_ticks, bool snaps)
    : course_(trace_course()),
      snapshot_ticks_(snapshot_ticks),
      snaps_(snaps),
      balls_(std::move(balls)),
      world_(course_, balls_),
      random_(seed) {}

void ArenaTrace::steer(TraceSnapshot& snapshot) {
    const double chance = 1.0 - physics::decay(kTraceChangesPerS / kTraceTickRateHz).factor;
    for (std::size_t i = 0; i < balls_.size(); ++i) {
        if (balls_[i].kind != static_cast<std::uint8_t>(replication::BallKind::kPlayer)) continue;
        if (random_.uniform() >= chance) continue;
        const Direction direction = kDirections[random_.below(kDirections.size())];
        BallState& ball = balls_[i];
        if (ball.thrust_x == direction.x && ball.thrust_y == direction.y) continue;
        ball.thrust_x = direction.x;
        ball.thrust_y = direction.y;
        world_.steer(i, ball);
        snapshot.events.push_back({tick_ + 1, ball.id, ball.thrust_x, ball.thrust_y, ball.brake});
    }
}

void ArenaTrace::snap() {
    const double before_j = world_.kinetic_energy_j();
    world_.snap();
    if (before_j > 0.0) energy_added_ += (world_.kinetic_energy_j() - before_j) / before_j;
}

TraceSnapshot ArenaTrace::next(const TickWatch& watch) {
    TraceSnapshot snapshot;
    for (replication::Tick i = 0; i < snapshot_ticks_; ++i, ++tick_) {
        steer(snapshot);
        if (watch.before) watch.before(world_.world());
        world_.advance(course_.tick_s);
        if (watch.after) watch.after(world_.world());
    }
    if (snaps_) snap();
    snapshot.tick = tick_;
    snapshot.balls = world_.balls();
    balls_ = snapshot.balls;
    return snapshot;
}

double ArenaTrace::rms_speed_mps() const {
    double sum = 0.0;
    for (const BallState& ball : balls_) {
        sum += std::pow(ball.vx * kTraceLattice.velocity_step_mps, 2) +
               std::pow(ball.vy * kTraceLattice.velocity_step_mps, 2);
    }
    return std::sqrt(sum / static_cast<double>(balls_.size()));
}

}  // namespace fts::lab
