#include "common/game/movement.h"

#include <cassert>
#include <cmath>

namespace fts::game {

physics::Control<double> control_for(const BallStats& stats, const InputCommand& input) {
    assert(stats.mass_kg > 0.0 && stats.top_speed_mps > 0.0);
    physics::Control<double> control;
    control.acceleration_mps2 = thrust_of(input) * (stats.thrust_n / stats.mass_kg);
    control.drag_per_s = stats.thrust_n / (stats.mass_kg * stats.top_speed_mps);
    if (input.brake) control.drag_per_s += stats.braking_per_s;
    return control;
}

std::optional<physics::Vec2d> advance_dash(DashState& state, const BallStats& stats,
                                           const InputCommand& input, int tick_rate_hz) {
    if (state.recharge_ticks > 0) --state.recharge_ticks;
    const physics::Vec2d direction = thrust_of(input);
    if (!input.dash || state.recharge_ticks > 0 || direction.isZero()) return std::nullopt;
    state.recharge_ticks =
        static_cast<std::uint32_t>(std::ceil(stats.dash_recharge_s * tick_rate_hz));
    return direction.normalized() * stats.dash_speed_mps;
}

}  // namespace fts::game
