#include "server/ai/pilot.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "common/game/rules.h"
#include "server/ai/steering.h"

namespace fts::server::ai {
namespace {

using physics::Vec2d;

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
// It does not correct an aim that is off by less than so many standard deviations of it ...
constexpr double kUnnoticedDeviations = 1.5;
// ... within this time.
constexpr int kAimsAnewAfterMs = 1000;

// Sine and cosine by their series: within 1e-6 up to the largest aim error, and the same bits
// everywhere.
Vec2d rotated(const Vec2d& v, double angle_rad) {
    const double x2 = angle_rad * angle_rad;
    const double sine =
        angle_rad * (1.0 - x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0))));
    const double cosine =
        1.0 - x2 / 2.0 * (1.0 - x2 / 12.0 * (1.0 - x2 / 30.0 * (1.0 - x2 / 56.0)));
    return {v.x() * cosine - v.y() * sine, v.x() * sine + v.y() * cosine};
}

// Mean 0, variance 1, within [-3.5, 3.5]: the sum of a few dice is nearly a bell.
double nearly_normal(Random& random) {
    constexpr int kDice = 4;
    double sum = 0.0;
    for (int i = 0; i < kDice; ++i) sum += random.between(-0.5, 0.5);
    constexpr double kPerDeviation = std::numbers::sqrt3;
    return sum * kPerDeviation;
}

// Powers of two, so that the axes and diagonals are among them.
int directions_told_apart(double aim_noise_deg) {
    int count = 8;
    while (360.0 / count > 2.0 * aim_noise_deg) count *= 2;
    return count;
}

// The nearest of `count` directions, evenly spread from +x on, in steps that are found within an
// eighth of a turn and mirrored.
Vec2d nearest_direction(const Vec2d& direction, int count) {
    const Vec2d size = direction.cwiseAbs();
    const bool steep = size.y() > size.x();
    const Vec2d folded = steep ? Vec2d(size.y(), size.x()) : size;
    Vec2d nearest = Vec2d::UnitX();
    for (int i = 1; i <= count / 8; ++i) {
        const Vec2d next = rotated(Vec2d::UnitX(), i * (2.0 * std::numbers::pi / count));
        if (next.dot(folded) > nearest.dot(folded)) nearest = next;
    }
    if (steep) std::swap(nearest.x(), nearest.y());
    return {std::copysign(nearest.x(), direction.x()), std::copysign(nearest.y(), direction.y())};
}

}  // namespace

Intent decide(game::Behaviour behaviour, const Situation& situation) {
    switch (behaviour) {
        case game::Behaviour::kChaser:
            return chase(situation);
        case game::Behaviour::kEdgeGuard:
            return guard_edge(situation);
        case game::Behaviour::kInterceptor:
            return intercept(situation);
        case game::Behaviour::kHerd:
            return run_with_herd(situation);
        case game::Behaviour::kCoward:
            return flee(situation);
        case game::Behaviour::kBruiser:
            return charge(situation);
    }
    return {};
}

bool matters(game::Behaviour behaviour, const SeenBall& other) {
    const bool are_herd =
        behaviour == game::Behaviour::kHerd && other.behaviour == game::Behaviour::kHerd;
    return other.is_player || are_herd;
}

Pilot::Pilot(game::Behaviour behaviour, game::Difficulty difficulty, std::uint64_t seed)
    : behaviour_(behaviour), skill_(skill_of(difficulty)), random_(seed) {
    // Spreads the decisions of a level's balls over its ticks.
    const int period = ticks_of_ms(skill_.decides_every_ms);
    ticks_to_decision_ = static_cast<int>(random_.below(static_cast<std::uint64_t>(period)));
}

game::InputCommand Pilot::command(std::uint16_t ball, const game::BallStats& stats,
                                  const physics::Platform& platform, const Memory& memory) {
    if (ticks_to_decision_ > 0) {
        --ticks_to_decision_;
        return held_;
    }
    ticks_to_decision_ = ticks_of_ms(skill_.decides_every_ms) - 1;
    if (const Frame* seen = memory.as_of(ticks_of_ms(skill_.reaction_ms)))
        held_ = decide_now(ball, stats, platform, *seen);
    return held_;
}

game::InputCommand Pilot::decide_now(std::uint16_t ball, const game::BallStats& stats,
                                     const physics::Platform& platform, const Frame& seen) {
    Situation situation{.platform = &platform,
                        .stats = stats,
                        .own = {},
                        .others = {},
                        .look_ahead_s = skill_.look_ahead_s};
    bool found = false;
    for (const SeenBall& ball_seen : seen) {
        if (ball_seen.id == ball) {
            // One knows one's own speed, and allows for being late.
            situation.own = ball_seen;
            situation.own.position_m += ball_seen.velocity_mps * (skill_.reaction_ms / 1000.0);
            found = true;
        } else if (matters(behaviour_, ball_seen)) {
            SeenBall& other = situation.others.emplace_back(ball_seen);
            other.position_m += other.velocity_mps * skill_.look_ahead_s;
        }
    }
    if (!found) {
        aimed_at_.reset();
        return {};
    }

    const double hold_s = skill_.decides_every_ms / 1000.0;
    const Intent wanted = decide(behaviour_, situation);
    const Intent held{.thrust = game::thrust_of(held_), .brake = held_.brake, .dash = held_.dash};
    aimed_for_ms_ += skill_.decides_every_ms;
    if (is_content(wanted) && leaves_room(situation, held, hold_s)) return held_;

    Intent intent = wanted;
    intent.thrust = aimed(wanted.thrust);
    const bool can_be_done = leaves_room(situation, intent, hold_s);
    aimed_at_ = can_be_done ? std::optional(wanted) : std::nullopt;
    aimed_for_ms_ = 0;
    if (!can_be_done) intent = kept_on_platform(situation, intent, hold_s);
    game::InputCommand command = game::command_toward(intent.thrust);
    command.brake = intent.brake;
    command.dash = intent.dash;
    return command;
}

bool Pilot::is_content(const Intent& wanted) const {
    if (!aimed_at_ || aimed_for_ms_ > kAimsAnewAfterMs) return false;
    const double off = (wanted.thrust - aimed_at_->thrust).norm();
    return off <= kUnnoticedDeviations * skill_.aim_noise_deg * kRadiansPerDegree &&
           wanted.brake == aimed_at_->brake && wanted.dash == aimed_at_->dash;
}

Vec2d Pilot::aimed(const Vec2d& thrust) {
    if (thrust.isZero(0.0)) return thrust;
    const int directions = directions_told_apart(skill_.aim_noise_deg);
    // Rounding to a step is as much noise as a twelfth of its square.
    const double step_deg = 360.0 / directions;
    const double deviation_deg =
        std::sqrt(skill_.aim_noise_deg * skill_.aim_noise_deg - step_deg * step_deg / 12.0);
    const double error_rad = nearly_normal(random_) * deviation_deg * kRadiansPerDegree;
    return nearest_direction(rotated(thrust, error_rad), directions) * thrust.norm();
}

}  // namespace fts::server::ai
