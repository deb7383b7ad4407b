// What a collision does to two velocities, in vector form, without angles: with n the unit line of
// centres from the second to the first and u = (v1 - v2).n < 0,
//
//     J = -(1 + e) u m1 m2 / (m1 + m2),   v1 += J/m1 n,   v2 -= J/m2 n.
//
// Computed along the line of centres d itself, as J n = -(1 + e) mu (w.d / d.d) d: the length of d
// cancels, so that energy does not depend on how well n is normalised. The impulse is then refined
// by what it leaves of w.d = -e w0.d: the rounding of 1/m1 + 1/m2 is the same in every collision of
// a pair, and would add up to 1e-16 of its energy each time.
#pragma once

#include <cmath>
#include <optional>

#include "common/physics/scene.h"

namespace fts::physics {

template <typename Scalar>
struct Impact {
    Vec2<Scalar> normal;                          // unit, from the second towards the first
    Scalar impulse_ns;                            // > 0
    Vec2<Scalar> velocity_1_mps, velocity_2_mps;  // afterwards
};

template <typename Scalar>
struct Mover {
    Vec2<Scalar> position_m;
    Vec2<Scalar> velocity_mps;
    Scalar mass_kg;  // infinite: not moved by the impact
};

// Empty when the two do not approach, or are both infinitely heavy: such pairs pass through each
// other.
template <typename Scalar>
inline std::optional<Impact<Scalar>> impact(const Mover<Scalar>& first, const Mover<Scalar>& second,
                                            Scalar restitution) {
    const Vec2<Scalar> d = first.position_m - second.position_m;
    const Vec2<Scalar> w = first.velocity_mps - second.velocity_mps;
    const Scalar rate = d.dot(w);
    const Scalar distance_squared = d.squaredNorm();
    const Scalar inverse_mass = Scalar(1) / first.mass_kg + Scalar(1) / second.mass_kg;
    if (!(rate < Scalar(0)) || !(distance_squared > Scalar(0)) || !(inverse_mass > Scalar(0))) {
        return std::nullopt;
    }
    Scalar strength = -(Scalar(1) + restitution) * (rate / distance_squared) / inverse_mass;
    const Vec2<Scalar> parting = w + strength * d / first.mass_kg + strength * d / second.mass_kg;
    strength -= (d.dot(parting) + restitution * rate) / distance_squared / inverse_mass;
    const Vec2<Scalar> impulse = strength * d;
    const Scalar distance = std::sqrt(distance_squared);
    return Impact<Scalar>{d / distance, strength * distance,
                          first.velocity_mps + impulse / first.mass_kg,
                          second.velocity_mps - impulse / second.mass_kg};
}

}  // namespace fts::physics
