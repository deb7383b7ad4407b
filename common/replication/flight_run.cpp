#include "common/replication/flight_run.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace fts::replication {
namespace {

using Contact = physics::Contact<double>;

class FlightRecorder {
  public:
    FlightRecorder(const Course& course, std::span<const BallState> balls, Tick ticks)
        : course_(course),
          world_(scene_of(course, balls), course.solver),
          ids_(world_.ids().begin(), world_.ids().end()),
          held_(balls.begin(), balls.end()) {
        assert(!course.scene.periodic);
        loose_.reserve(balls.size() * (ticks + 2));
        run_.balls.resize(balls.size());
        for (std::uint32_t i = 0; i < ids_.size(); ++i) {
            const physics::BodyView<double> body = world_.body(ids_[i]);
            run_.balls[i] = {body.radius_m, body.mass_kg, body.position_m, body.velocity_mps};
            loose_.push_back({i, {0.0, body.position_m}});
            control(i, physics::Vec2d::Zero());
        }
    }

    // `events` are those of the next tick.
    void steer(std::span<const ControlEvent> events);
    void push(const Pushes& pushes, Tick tick) {
        for (std::size_t i = 0; i < ids_.size(); ++i) control(i, pushes.at(tick, i));
    }
    void advance(Tick tick);
    FlightRun finish();

  private:
    struct LooseKnot {
        std::uint32_t ball;
        Knot knot;
    };

    void control(std::size_t ball, const physics::Vec2d& push_mps2);
    void write(const Contact& contact, double tick_start_s);

    const Course& course_;
    physics::World<double> world_;
    std::vector<physics::BodyId> ids_;
    std::vector<BallState> held_;   // with the controls they hold now
    std::vector<LooseKnot> loose_;  // as they came
    FlightRun run_;
};

void FlightRecorder::steer(std::span<const ControlEvent> events) {
    for (const ControlEvent& event : events) {
        const auto ball = std::ranges::lower_bound(held_, event.ball, {}, &BallState::id);
        if (ball == held_.end() || ball->id != event.ball) continue;
        ball->thrust_x = event.thrust_x;
        ball->thrust_y = event.thrust_y;
        ball->brake = event.brake;
        const auto index = static_cast<std::size_t>(ball - held_.begin());
        control(index, physics::Vec2d::Zero());
        if (!event.dash || !course_.dash_of || run_.balls[index].fell) continue;
        const physics::BodyId id = ids_[index];
        world_.set_velocity(id, world_.body(id).velocity_mps + course_.dash_of(*ball));
    }
}

void FlightRecorder::control(std::size_t ball, const physics::Vec2d& push_mps2) {
    if (run_.balls[ball].fell) return;
    physics::Control<double> control;
    if (course_.control_of) control = course_.control_of(held_[ball]);
    control.acceleration_mps2 += push_mps2;
    world_.set_control(ids_[ball], control);
}

void FlightRecorder::write(const Contact& contact, double tick_start_s) {
    RunHit hit;
    hit.time_s = tick_start_s + contact.time_s;
    hit.a = contact.a.index;
    hit.b = contact.b ? contact.b->index : static_cast<std::uint32_t>(ids_.size());
    hit.normal = contact.normal;
    hit.approach_mps = contact.velocity_a_before_mps - contact.velocity_b_before_mps;
    hit.impulse_ns = contact.impulse_ns;
    hit.inverse_mass_a = 1.0 / contact.mass_a_kg;
    loose_.push_back({hit.a, {hit.time_s, contact.position_a_m}});
    if (contact.b) {
        hit.inverse_mass_b = 1.0 / contact.mass_b_kg;
        hit.inverse_reach = 1.0 / (run_.balls[hit.a].radius_m + run_.balls[hit.b].radius_m);
        loose_.push_back({hit.b, {hit.time_s, contact.position_b_m}});
    }
    if (contact.contacts_at_once == 1) run_.hits.push_back(hit);
}

void FlightRecorder::advance(Tick tick) {
    const double start_s = course_.tick_s * tick;
    world_.step(course_.tick_s);
    for (const Contact& contact : world_.contacts()) write(contact, start_s);
    for (RunBall& ball : run_.balls) {
        if (ball.fell) ball.end_m += ball.end_mps * course_.tick_s;
    }
    for (const physics::Fall<double>& fall : world_.falls()) {
        RunBall& ball = run_.balls[fall.id.index];
        ball.fell = true;
        ball.end_mps = fall.velocity_mps;
        ball.end_m = fall.position_m + fall.velocity_mps * (course_.tick_s - fall.time_s);
    }
    for (const physics::BodyId id : world_.ids()) {
        const physics::BodyView<double> body = world_.body(id);
        run_.balls[id.index].end_m = body.position_m;
        run_.balls[id.index].end_mps = body.velocity_mps;
    }
    for (std::uint32_t i = 0; i < ids_.size(); ++i) {
        loose_.push_back({i, {start_s + course_.tick_s, run_.balls[i].end_m}});
    }
}

FlightRun FlightRecorder::finish() {
    run_.first_knot.assign(ids_.size() + 1, 0);
    for (const LooseKnot& loose : loose_) ++run_.first_knot[loose.ball + 1];
    for (std::size_t i = 0; i < ids_.size(); ++i) run_.first_knot[i + 1] += run_.first_knot[i];
    std::vector<std::uint32_t> next(run_.first_knot.begin(), run_.first_knot.end() - 1);
    run_.knots.resize(loose_.size());
    for (const LooseKnot& loose : loose_) run_.knots[next[loose.ball]++] = loose.knot;
    return std::move(run_);
}

}  // namespace

FlightRun run_flight(const Course& course, std::span<const BallState> balls, Tick from, Tick ticks,
                     std::span<const ControlEvent> events, const Pushes& pushes) {
    std::vector<ControlEvent> in_time(events.begin(), events.end());
    std::ranges::stable_sort(in_time, {}, &ControlEvent::tick);
    FlightRecorder recorder(course, balls, ticks);
    auto next = in_time.begin();
    for (Tick tick = 0; tick < ticks; ++tick) {
        const auto due = next;
        while (next != in_time.end() && next->tick <= from + tick + 1) ++next;
        recorder.steer({due, next});
        if (!pushes.mps2.empty()) recorder.push(pushes, tick);
        recorder.advance(tick);
    }
    return recorder.finish();
}

}  // namespace fts::replication
