#include "common/physics/time_of_impact.h"

namespace fts::physics {
namespace {

template <typename Scalar>
Scalar time_until_outside_disc(Scalar radius_m, const Vec2<Scalar>& position_m,
                               const Vec2<Scalar>& velocity_mps) {
    const Scalar distance = position_m.norm();
    if (distance > radius_m) return Scalar(0);
    const Scalar speed = velocity_mps.norm();
    if (!(speed > Scalar(0))) return kNever<Scalar>;
    const Scalar along = position_m.dot(velocity_mps) / speed;
    const Scalar chord = half_chord(radius_m, std::abs(cross(position_m, velocity_mps)) / speed);
    if (along <= Scalar(0)) return (chord - along) / speed;
    return (radius_m - distance) * (radius_m + distance) / ((chord + along) * speed);
}

template <typename Scalar>
Scalar time_until_edge_of(const Disc& disc, const Vec2<Scalar>& position_m,
                          const Vec2<Scalar>& velocity_mps) {
    return time_until_outside_disc(static_cast<Scalar>(disc.radius_m), position_m, velocity_mps);
}

template <typename Scalar>
Scalar time_until_edge_of(const Ring& ring, const Vec2<Scalar>& position_m,
                          const Vec2<Scalar>& velocity_mps) {
    const Scalar inner = static_cast<Scalar>(ring.inner_radius_m);
    if (position_m.norm() < inner) return Scalar(0);
    return std::min(time_until_contact(position_m, velocity_mps, inner),
                    time_until_outside_disc(static_cast<Scalar>(ring.outer_radius_m), position_m,
                                            velocity_mps));
}

template <typename Scalar>
Scalar time_until_edge_of(const Rectangle& rectangle, const Vec2<Scalar>& position_m,
                          const Vec2<Scalar>& velocity_mps) {
    Scalar first = kNever<Scalar>;
    for (int axis = 0; axis < 2; ++axis) {
        const Scalar half = static_cast<Scalar>(rectangle.half_extents_m[axis]);
        if (std::abs(position_m[axis]) > half) return Scalar(0);
        first = std::min({first, time_until_wall(half - position_m[axis], velocity_mps[axis]),
                          time_until_wall(half + position_m[axis], -velocity_mps[axis])});
    }
    return first;
}

// What is left of a platform's square when its edge is to be out of reach beyond doubt.
template <typename Scalar>
constexpr Scalar kWellInside = Scalar(0.999);

template <typename Scalar>
bool stays_on(const Disc& disc, const Vec2<Scalar>& position_m, const Vec2<Scalar>& way_m) {
    const auto radius = static_cast<Scalar>(disc.radius_m);
    return (position_m.cwiseAbs() + way_m).squaredNorm() < kWellInside<Scalar> * radius * radius;
}

template <typename Scalar>
bool stays_on(const Ring& ring, const Vec2<Scalar>& position_m, const Vec2<Scalar>& way_m) {
    const Scalar near = static_cast<Scalar>(ring.inner_radius_m) + way_m.x() + way_m.y();
    return near * near < kWellInside<Scalar> * position_m.squaredNorm() &&
           stays_on(Disc{ring.outer_radius_m}, position_m, way_m);
}

template <typename Scalar>
bool stays_on(const Rectangle& rectangle, const Vec2<Scalar>& position_m,
              const Vec2<Scalar>& way_m) {
    const Vec2<Scalar> half = kWellInside<Scalar> * rectangle.half_extents_m.cast<Scalar>();
    return ((position_m.cwiseAbs() + way_m).array() < half.array()).all();
}

}  // namespace

template <typename Scalar>
Scalar time_until_wall(Scalar gap_m, Scalar closing_speed_mps) {
    if (!(closing_speed_mps > Scalar(0))) return kNever<Scalar>;
    return gap_m > Scalar(0) ? gap_m / closing_speed_mps : Scalar(0);
}

template <typename Scalar>
Scalar time_until_edge(const Platform& platform, const Vec2<Scalar>& position_m,
                       const Vec2<Scalar>& velocity_mps) {
    return std::visit(
        [&](const auto& shape) { return time_until_edge_of(shape, position_m, velocity_mps); },
        platform);
}

template <typename Scalar>
bool surely_stays(const Platform& platform, const Vec2<Scalar>& position_m,
                  const Vec2<Scalar>& way_m) {
    return std::visit([&](const auto& shape) { return stays_on<Scalar>(shape, position_m, way_m); },
                      platform);
}

template double time_until_wall(double, double);
template float time_until_wall(float, float);
template double time_until_edge(const Platform&, const Vec2<double>&, const Vec2<double>&);
template float time_until_edge(const Platform&, const Vec2<float>&, const Vec2<float>&);
template bool surely_stays(const Platform&, const Vec2<double>&, const Vec2<double>&);
template bool surely_stays(const Platform&, const Vec2<float>&, const Vec2<float>&);

}  // namespace fts::physics
