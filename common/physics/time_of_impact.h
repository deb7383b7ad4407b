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

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/physics/scene.h"

namespace fts::physics {

template <typename Scalar>
inline constexpr Scalar kNever = std::numeric_limits<Scalar>::infinity();

template <typename Scalar>
inline Scalar cross(const Vec2<Scalar>& a, const Vec2<Scalar>& b) {
    return a.x() * b.y() - a.y() * b.x();
}

// Half the chord that a line at distance `offset_m` from the centre cuts from a circle; NaN-free.
template <typename Scalar>
inline Scalar half_chord(Scalar radius_m, Scalar offset_m) {
    return std::sqrt(std::max(Scalar(0), (radius_m - offset_m) * (radius_m + offset_m)));
}

// Two discs: `separation_m` and `relative_velocity_mps` are first minus second, `reach_m` the sum
// of radii.
template <typename Scalar>
inline Scalar time_until_contact(const Vec2<Scalar>& separation_m,
                                 const Vec2<Scalar>& relative_velocity_mps, Scalar reach_m) {
    const Scalar rate = separation_m.dot(relative_velocity_mps);
    if (!(rate < Scalar(0))) return kNever<Scalar>;
    const Scalar distance = separation_m.norm();
    if (distance <= reach_m) return Scalar(0);
    const Scalar speed = relative_velocity_mps.norm();
    if (!(speed > Scalar(0))) return kNever<Scalar>;
    const Scalar passing = std::abs(cross(separation_m, relative_velocity_mps)) / speed;
    if (passing > reach_m) return kNever<Scalar>;
    const Scalar chord = half_chord(reach_m, passing);
    return (distance - reach_m) * (distance + reach_m) / ((chord - rate / speed) * speed);
}

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
