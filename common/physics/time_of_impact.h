// When straight motions meet. Pure functions; times are from now, in [0, inf]; kNever when they do
// not meet.
//
// What overlaps and approaches meets now; what recedes never does, overlapping or not (Bannerman,
// Strobl, Formella and Poeschel, "Stable algorithm for event detection in event-driven particle
// dynamics", 2014).
//
// Roots are taken in the form that adds numbers of one sign: with p the distance at which the
// centres would pass and s = sqrt((R - p)(R + p)) half the chord, no small difference of large
// squares is formed.
#pragma once

#include <limits>

#include "common/physics/scene.h"

namespace fts::physics {

template <typename Scalar>
inline constexpr Scalar kNever = std::numeric_limits<Scalar>::infinity();

// Two discs: `separation_m` and `relative_velocity_mps` are first minus second, `reach_m` the sum
// of radii.
template <typename Scalar>
Scalar time_until_contact(const Vec2<Scalar>& separation_m,
                          const Vec2<Scalar>& relative_velocity_mps, Scalar reach_m);

// A straight wall at distance `gap_m` that is approached at `closing_speed_mps`.
template <typename Scalar>
Scalar time_until_wall(Scalar gap_m, Scalar closing_speed_mps);

// The moment the point leaves the platform; 0 when it is off it already.
template <typename Scalar>
Scalar time_until_edge(const Platform& platform, const Vec2<Scalar>& position_m,
                       const Vec2<Scalar>& velocity_mps);

// Whether a way of at most `way_m` on each axis, not negative, leads to nowhere near the edge of
// the platform: cheaper than to ask when.
template <typename Scalar>
bool surely_stays(const Platform& platform, const Vec2<Scalar>& position_m,
                  const Vec2<Scalar>& way_m);

}  // namespace fts::physics
