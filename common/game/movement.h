// Movement is shared source: state + input -> what the physics applies. Server, predictor and bots
// call the same two functions, never a copy.
#pragma once

#include "common/game/input.h"
#include "common/game/upgrades.h"
#include "common/physics/world.h"

namespace fts::game {

// How a ball answers to what is asked of it: all that moving it takes besides its mass.
struct Handling {
    double acceleration_mps2 = 0.0;  // at full thrust
    double drag_per_s = 0.0;
    double braking_per_s = 0.0;  // drag added while the brake is held
    double dash_mps = 0.0;       // velocity change of one dash
};
// Acceleration F/m; drag F/(m v_top), so that full thrust tends to the top speed and a heavier ball
// coasts further.
Handling handling_of(const BallStats& stats);

physics::Control<double> control_for(const Handling& handling, const InputCommand& input);
// The velocity change of a dash along the thrust; zero without one.
physics::Vec2d dash_for(const Handling& handling, const InputCommand& input);

struct DashState {
    std::uint32_t recharge_ticks = 0;  // 0: ready
};
// Advances the recharge by one tick; true when a dash is asked for, ready and has a direction: it
// fires, and the recharge begins anew.
bool advance_dash(DashState& state, const BallStats& stats, const InputCommand& input,
                  int tick_rate_hz);

}  // namespace fts::game
