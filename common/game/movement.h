// Movement is shared source: state + input -> what the physics applies. Server, predictor and bots
// call the same two functions, never a copy.
#pragma once

#include "common/game/input.h"
#include "common/game/upgrades.h"
#include "common/physics/world.h"

namespace fts::game {

// Acceleration F/m along the thrust; drag F/(m v_top), so that full thrust tends to the top speed
// and a heavier ball coasts further. Braking adds its own drag.
physics::Control<double> control_for(const BallStats& stats, const InputCommand& input);

struct DashState {
    std::uint32_t recharge_ticks = 0;  // 0: ready
};
// Advances the recharge by one tick and, when a dash is asked for, ready and has a direction,
// returns the velocity change of it.
std::optional<physics::Vec2d> advance_dash(DashState& state, const BallStats& stats,
                                           const InputCommand& input, int tick_rate_hz);

}  // namespace fts::game
