// What all pilots know of moving a ball: where it will be when a command reaches it, how to get to
// a point, and how not to fall off on the way.
#pragma once

#include <optional>

#include "client/bot/field.h"
#include "common/game/input.h"
#include "common/game/upgrades.h"
#include "common/physics/scene.h"

namespace fts::bot {

// Kept free between the centre of the own ball and the edge.
inline constexpr double kEdgeMarginM = 0.5;

struct Helm {
    physics::Vec2d position_m = physics::Vec2d::Zero();  // when the next command acts
    physics::Vec2d velocity_mps = physics::Vec2d::Zero();
    double radius_m = 0.0;
    double mass_kg = 0.0;
    double lag_s = 0.0;              // as of the sight
    double acceleration_mps2 = 0.0;  // of full thrust
    double top_speed_mps = 0.0;
    physics::Platform platform;
};

// Empty while the own ball is not on the platform.
std::optional<Helm> take_helm(const Sight& sight);

// Where a ball that is seen at `ball` will be `after_s` after the next command acts.
physics::Vec2d ahead(const Helm& helm, const FieldBall& ball, double after_s);

// The point of the platform that is furthest from every edge and nearest to `near_m`.
physics::Vec2d innermost_point_m(const physics::Platform& platform, const physics::Vec2d& near_m);

// The fastest velocity outwards at which the ball can still be stopped before the edge.
double safe_speed_mps(const Helm& helm, double distance_to_edge_m);

// Full thrust so that the velocity becomes `velocity_mps`.
game::InputCommand fly_at(const Helm& helm, const physics::Vec2d& velocity_mps);
// To a point and to rest there, around a hole if one is in the way.
game::InputCommand fly_to(const Helm& helm, const physics::Vec2d& point_m);
// `wanted`, unless that would carry the ball over the edge: then away from it.
game::InputCommand stay_on(const Helm& helm, const game::InputCommand& wanted);

}  // namespace fts::bot
