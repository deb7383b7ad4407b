#include "common/physics/impact.h"

#include <cmath>

namespace fts::physics {

template <typename Scalar>
std::optional<Impact<Scalar>> impact(const Mover<Scalar>& first, const Mover<Scalar>& second,
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

template std::optional<Impact<double>> impact(const Mover<double>&, const Mover<double>&, double);
template std::optional<Impact<float>> impact(const Mover<float>&, const Mover<float>&, float);

}  // namespace fts::physics
