// What a solver that moves bodies without looking does at the boundary afterwards: a disc beyond a
// wall is put back to it and sent the other way; a centre beyond the platform's edge is off.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "common/physics/diagnostics.h"
#include "common/physics/solver.h"

namespace fts::physics {

// Where the centre of a disc may be.
template <typename Scalar>
typename Model<Scalar>::Box room_for(const typename Model<Scalar>::Box& walls, Scalar radius_m) {
    const Vec2<Scalar> margin = Vec2<Scalar>::Constant(radius_m);
    return {walls.min_m + margin, walls.max_m - margin};
}

template <typename Scalar>
bool is_within(const typename Model<Scalar>::Box& room, Scalar x_m, Scalar y_m) {
    return x_m >= room.min_m.x() && x_m <= room.max_m.x() && y_m >= room.min_m.y() &&
           y_m <= room.max_m.y();
}

template <typename Scalar>
struct WallHitter {
    BodyId id;
    Vec2<Scalar> position_m, velocity_mps;
    Scalar radius_m, mass_kg;
};

// For a body that is not within `room`. Only what moves on into a wall collides with it. Returns
// the number of collisions.
template <typename Scalar>
std::uint32_t bounce(WallHitter<Scalar>& body, const typename Model<Scalar>::Box& room,
                     Scalar restitution, Scalar time_s, Record<Scalar>& record) {
    std::uint32_t collisions = 0;
    for (int axis = 0; axis < 2; ++axis) {
        Scalar& x = body.position_m[axis];
        const bool below = x < room.min_m[axis];
        if (!below && !(x > room.max_m[axis])) continue;
        const Scalar outside_m = below ? room.min_m[axis] - x : x - room.max_m[axis];
        x = below ? room.min_m[axis] : room.max_m[axis];
        Vec2<Scalar> normal = Vec2<Scalar>::Zero();
        normal[axis] = below ? Scalar(1) : Scalar(-1);
        const Vec2<Scalar> before = body.velocity_mps;
        if (!(before[axis] * normal[axis] < Scalar(0))) continue;
        body.velocity_mps[axis] *= -restitution;
        const Vec2<Scalar> wall_m = body.position_m - body.radius_m * normal;
        Contact<Scalar> contact{body.id,
                                std::nullopt,
                                time_s,
                                wall_m,
                                normal,
                                body.mass_kg * std::abs(body.velocity_mps[axis] - before[axis]),
                                body.position_m,
                                wall_m,
                                before,
                                body.velocity_mps,
                                Vec2<Scalar>::Zero(),
                                Vec2<Scalar>::Zero(),
                                body.mass_kg,
                                std::numeric_limits<Scalar>::infinity()};
        contact.penetration = outside_m / body.radius_m;
        record.contacts.push_back(contact);
        account(contact, record.audit);
        ++collisions;
    }
    return collisions;
}

template <typename Scalar>
bool is_off(const Disc& disc, Scalar x_m, Scalar y_m) {
    const auto radius = static_cast<Scalar>(disc.radius_m);
    return x_m * x_m + y_m * y_m > radius * radius;
}
template <typename Scalar>
bool is_off(const Rectangle& rectangle, Scalar x_m, Scalar y_m) {
    return std::abs(x_m) > static_cast<Scalar>(rectangle.half_extents_m.x()) ||
           std::abs(y_m) > static_cast<Scalar>(rectangle.half_extents_m.y());
}
template <typename Scalar>
bool is_off(const Ring& ring, Scalar x_m, Scalar y_m) {
    const auto inner = static_cast<Scalar>(ring.inner_radius_m);
    const auto outer = static_cast<Scalar>(ring.outer_radius_m);
    const Scalar squared = x_m * x_m + y_m * y_m;
    return squared < inner * inner || squared > outer * outer;
}

}  // namespace fts::physics
