#include "common/replication/snapshot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace fts::replication {
namespace {

template <typename Entry>
bool ascends(const std::vector<Entry>& entries) {
    const auto out_of_order = [](const Entry& a, const Entry& b) { return a.id >= b.id; };
    return std::adjacent_find(entries.begin(), entries.end(), out_of_order) == entries.end();
}

bool hits_ascend(const std::vector<HitState>& hits) {
    return std::is_sorted(hits.begin(), hits.end(), [](const HitState& a, const HitState& b) {
        return std::tie(a.tick, a.a, a.b) < std::tie(b.tick, b.a, b.b);
    });
}

bool has_known_enums(const BallState& ball) {
    return ball.kind <= static_cast<std::uint8_t>(BallKind::kPlayer) &&
           ball.behaviour <= static_cast<std::uint8_t>(kLastBehaviour);
}

}  // namespace

bool same_body(const BallState& a, const BallState& b) {
    return a.radius == b.radius && a.mass == b.mass && a.kind == b.kind &&
           a.behaviour == b.behaviour && a.player_id == b.player_id && a.handling == b.handling;
}

void take_body(const BallState& from, BallState& to) {
    to.radius = from.radius;
    to.mass = from.mass;
    to.kind = from.kind;
    to.behaviour = from.behaviour;
    to.player_id = from.player_id;
    to.handling = from.handling;
}

bool is_canonical(const Snapshot& snapshot) {
    return snapshot.phase <= game::Phase::kShop && ascends(snapshot.balls) &&
           ascends(snapshot.coins) && hits_ascend(snapshot.hits) &&
           std::all_of(snapshot.balls.begin(), snapshot.balls.end(), has_known_enums);
}

std::int32_t quantise(double value, double step) {
    if (std::isnan(value)) return 0;
    constexpr double kLowest = std::numeric_limits<std::int32_t>::min();
    constexpr double kGreatest = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(std::clamp(std::round(value / step), kLowest, kGreatest));
}

bool in_range(double value, double step) {
    constexpr double kLowest = std::numeric_limits<std::int32_t>::min();
    constexpr double kGreatest = std::numeric_limits<std::int32_t>::max();
    const double steps = std::round(value / step);
    return steps >= kLowest && steps <= kGreatest;
}

double dequantise(std::int64_t steps, double step) {
    return static_cast<double>(steps) * step;
}

physics::Vec2d place_m(std::int32_t x, std::int32_t y) {
    return {dequantise(x, kPositionStepM), dequantise(y, kPositionStepM)};
}

physics::Vec2d position_of(const BallState& ball) {
    return place_m(ball.x, ball.y);
}

physics::Vec2d velocity_of(const BallState& ball) {
    return {dequantise(ball.vx, kVelocityStepMps), dequantise(ball.vy, kVelocityStepMps)};
}

}  // namespace fts::replication
