#include "common/replication/predictor.h"

#include <algorithm>
#include <cassert>

#include "common/replication/doubt_tracker.h"

namespace fts::replication {
namespace {

std::int32_t straight_on(std::int32_t place, std::int32_t speed, double span_s,
                         const Lattice& lattice) {
    return quantise(dequantise(place, lattice.position_step_m) +
                        dequantise(speed, lattice.velocity_step_mps) * span_s,
                    lattice.position_step_m);
}

std::vector<BallState> in_straight_lines(const Lattice& lattice,
                                         std::span<const BallState> baseline, double span_s) {
    std::vector<BallState> balls(baseline.begin(), baseline.end());
    for (BallState& ball : balls) {
        ball.x = straight_on(ball.x, ball.vx, span_s, lattice);
        ball.y = straight_on(ball.y, ball.vy, span_s, lattice);
    }
    return balls;
}

// Steps of `step_ticks`, the last one shorter where they do not fit.
std::vector<BallState> by_physics(const Course& course, Tick step_ticks, Tick snap_every,
                                  std::span<const BallState> baseline, Tick ticks,
                                  DoubtTracker& doubts) {
    LatticeWorld world(course, baseline);
    for (Tick tick = 0; tick < ticks; tick += step_ticks) {
        if (snap_every > 0 && tick > 0 && tick % snap_every == 0) world.snap();
        world.advance(course.tick_s * std::min(step_ticks, ticks - tick));
        doubts.follow(world.contacts(), course.tick_s * tick);
    }
    return world.balls();
}

// Their controls are not known; what drags at them is.
std::vector<BallState> unsteered(std::span<const BallState> baseline) {
    std::vector<BallState> balls(baseline.begin(), baseline.end());
    for (BallState& ball : balls) {
        ball.thrust_x = ball.thrust_y = 0;
        ball.brake = false;
    }
    return balls;
}

}  // namespace

Prediction predict(const Course& course, const Steering& steering, Foresight foresight,
                   std::span<const BallState> baseline, Tick baseline_tick, Tick tick) {
    assert(tick > baseline_tick);
    const Tick ticks = tick - baseline_tick;
    const double span_s = course.tick_s * ticks;
    const bool on_lattice = foresight == Foresight::kControlsOnLattice;
    DoubtTracker doubts(course.lattice, baseline, !on_lattice, steering.unforeseen_mps2);
    std::vector<BallState> balls;
    if (foresight == Foresight::kStraightLines) {
        balls = in_straight_lines(course.lattice, baseline, span_s);
    } else if (foresight == Foresight::kCollisions) {
        balls = by_physics(course, steering.snapshot_ticks, 0, unsteered(baseline), ticks, doubts);
    } else {
        balls = by_physics(course, 1, on_lattice ? steering.snapshot_ticks : 0, baseline, ticks,
                           doubts);
    }
    Prediction prediction{baseline_tick, tick, std::vector<Expectation>(balls.size())};
    doubts.judge(span_s, prediction.balls);
    for (std::size_t i = 0; i < balls.size(); ++i) {
        BallState& state = prediction.balls[i].state;
        state = balls[i];
        state.thrust_x = baseline[i].thrust_x;
        state.thrust_y = baseline[i].thrust_y;
        state.brake = baseline[i].brake;
    }
    return prediction;
}

}  // namespace fts::replication
