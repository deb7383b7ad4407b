#include "common/game/movement.h"

#include <cassert>
#include <cmath>

namespace fts::game {

Handling handling_of(const BallStats& stats) {
    assert(stats.mass_kg > 0.0 && stats.top_speed_mps > 0.0);
    return {.acceleration_mps2 = stats.thrust_n / stats.mass_kg,
            .drag_per_s = stats.thrust_n / (stats.mass_kg * stats.top_speed_mps),
            .braking_per_s = stats.braking_per_s,
            .dash_mps = stats.dash_speed_mps};
}

physics::Control<double> control_for(const Handling& handling, const InputCommand& input) {
    physics::Control<double> control;
    control.acceleration_mps2 = thrust_of(input) * handling.acceleration_mps2;
    control.drag_per_s = handling.drag_per_s;
    if (input.brake) control.drag_per_s += handling.braking_per_s;
    return control;
}

physics::Vec2d dash_for(const Handling& handling, const InputCommand& input) {
    const physics::Vec2d direction = thrust_of(input);
    if (direction.isZero()) return physics::Vec2d::Zero();
    return direction.normalized() * handling.dash_mps;
}

bool advance_dash(DashState& state, const BallStats& stats, const InputCommand& input,
                  int tick_rate_hz) {
    if (state.recharge_ticks > 0) --state.recharge_ticks;
    if (!input.dash || state.recharge_ticks > 0 || thrust_of(input).isZero()) return false;
    state.recharge_ticks =
        static_cast<std::uint32_t>(std::ceil(stats.dash_recharge_s * tick_rate_hz));
    return true;
}

}  // namespace fts::game
