// What the behaviours have in common: choosing a target, going somewhere, staying on the platform.
#pragma once

#include "server/ai/behaviours.h"

namespace fts::server::ai {

physics::Vec2d unit_or_zero(const physics::Vec2d& vector);

// The nearest ball of a player; nullptr when there is none.
const SeenBall* nearest_player(const Situation& situation);

// Towards the goal at full thrust, killing sideways motion, around the hole of a ring.
Intent seek(const Situation& situation, const physics::Vec2d& goal_m);
// The same, and stops there.
Intent arrive(const Situation& situation, const physics::Vec2d& goal_m);
// When there is nobody to play with: a quiet place away from the edge.
Intent rest(const Situation& situation);

// The point from which a push through the target's centre sends it over the edge nearest to it,
// where the surfaces touch; `standoff_m` further away from the target.
physics::Vec2d ghost_ball_m(const Situation& situation, const SeenBall& target, double standoff_m);

// Whether holding it for `hold_s` leaves room to stop before the edge: v^2 / 2a against the
// distance along the way.
bool leaves_room(const Situation& situation, const Intent& intent, double hold_s);
// The intent itself when it leaves room; otherwise braking and steering back.
Intent kept_on_platform(const Situation& situation, const Intent& intent, double hold_s);

}  // namespace fts::server::ai
