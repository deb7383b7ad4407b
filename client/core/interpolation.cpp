#include "client/core/interpolation.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace fts::client {
namespace {

using replication::BallState;
using replication::Snapshot;

BallPose coasting(const BallState& ball, double span_s) {
    const physics::Vec2d velocity_mps = velocity_of(ball);
    return {&ball, position_of(ball) + velocity_mps * span_s, velocity_mps};
}

BallPose between(const BallState& from, const BallState& to, double share, double span_s) {
    const physics::Vec2d p0 = position_of(from), p1 = position_of(to);
    const physics::Vec2d v0 = velocity_of(from), v1 = velocity_of(to);
    const double reach_m =
        2.0 * std::max(v0.norm(), v1.norm()) * span_s + replication::kTeleportSlackM;
    if ((p1 - p0).norm() > reach_m) return coasting(from, 0.0);
    return {&from, p0 + (p1 - p0) * share, v0 + (v1 - v0) * share};
}

std::vector<BallPose> all_coasting(const Snapshot& snapshot, double span_s) {
    std::vector<BallPose> poses;
    poses.reserve(snapshot.balls.size());
    for (const BallState& ball : snapshot.balls) poses.push_back(coasting(ball, span_s));
    return poses;
}

}  // namespace

std::vector<BallPose> interpolate(const Snapshot& from, const Snapshot& to, double draw_tick,
                                  int tick_rate_hz) {
    assert(from.tick <= to.tick && tick_rate_hz > 0);
    const double rate = tick_rate_hz;
    if (draw_tick >= to.tick) {
        return all_coasting(to, std::min((draw_tick - to.tick) / rate, kMaxExtrapolationS));
    }
    if (draw_tick <= from.tick) return all_coasting(from, 0.0);

    const double since_from_s = (draw_tick - from.tick) / rate;
    const double span_s = (to.tick - from.tick) / rate;
    std::vector<BallPose> poses;
    poses.reserve(from.balls.size());
    auto target = to.balls.begin();
    for (const BallState& ball : from.balls) {
        while (target != to.balls.end() && target->id < ball.id) ++target;
        const bool in_both = target != to.balls.end() && target->id == ball.id;
        poses.push_back(in_both ? between(ball, *target, since_from_s / span_s, span_s)
                                : coasting(ball, std::min(since_from_s, kMaxExtrapolationS)));
    }
    return poses;
}

const replication::FlightPaths& FlightInterpolation::paths_beyond(const Snapshot& newest) {
    if (!has_paths_ || from_tick_ != newest.tick || to_tick_ != newest.tick) {
        const auto ticks =
            static_cast<replication::Tick>(std::ceil(kMaxExtrapolationS / course_.tick_s));
        paths_ = replication::paths_beyond(course_, newest.balls, ticks);
        from_tick_ = to_tick_ = newest.tick;
        has_paths_ = true;
    }
    return paths_;
}

const replication::FlightPaths& FlightInterpolation::paths_between(
    const Snapshot& from, const Snapshot& to, std::span<const replication::ControlEvent> controls) {
    if (!has_paths_ || from_tick_ != from.tick || to_tick_ != to.tick) {
        paths_ =
            replication::paths_between(course_, from.balls, from.tick, to.balls, to.tick, controls);
        from_tick_ = from.tick;
        to_tick_ = to.tick;
        has_paths_ = true;
    }
    return paths_;
}

std::vector<BallPose> FlightInterpolation::at(const Snapshot& from, const Snapshot& to,
                                              std::span<const replication::ControlEvent> controls,
                                              double draw_tick) {
    assert(from.tick <= to.tick);
    const bool beyond = draw_tick >= to.tick;
    const Snapshot& start = beyond ? to : from;
    if (draw_tick <= start.tick) return all_coasting(start, 0.0);
    const double since_s = (draw_tick - start.tick) * course_.tick_s;
    const replication::FlightPaths& paths =
        beyond ? paths_beyond(to) : paths_between(from, to, controls);
    const double shown_s = beyond ? std::min(since_s, kMaxExtrapolationS) : since_s;
    std::vector<BallPose> poses;
    poses.reserve(start.balls.size());
    for (std::size_t i = 0; i < start.balls.size(); ++i) {
        const replication::FlightPose pose = paths.at(i, shown_s);
        poses.push_back({&start.balls[i], pose.position_m, pose.velocity_mps});
    }
    return poses;
}

}  // namespace fts::client
