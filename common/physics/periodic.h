// Places in a box whose opposite sides are one.
#pragma once

#include <cmath>
#include <optional>

#include "common/physics/solver.h"

namespace fts::physics {

// `separation_m` to the nearest of the other's images: within half the box in each coordinate.
template <typename Scalar>
Vec2<Scalar> nearest_image(Vec2<Scalar> separation_m,
                           const std::optional<typename Model<Scalar>::Box>& box) {
    if (!box) return separation_m;
    const Vec2<Scalar> extent = box->extent_m();
    for (int axis = 0; axis < 2; ++axis) {
        if (std::abs(separation_m[axis]) < Scalar(0.49) * extent[axis]) continue;
        separation_m[axis] -= extent[axis] * std::round(separation_m[axis] / extent[axis]);
    }
    return separation_m;
}

// The image of `position_m` that is in [min, max).
template <typename Scalar>
Vec2<Scalar> wrapped(Vec2<Scalar> position_m, const typename Model<Scalar>::Box& box) {
    const Vec2<Scalar> extent = box.extent_m();
    for (int axis = 0; axis < 2; ++axis) {
        Scalar& x = position_m[axis];
        if (x >= box.min_m[axis] && x < box.max_m[axis]) continue;
        x -= extent[axis] * std::floor((x - box.min_m[axis]) / extent[axis]);
        if (!(x >= box.min_m[axis])) x = box.min_m[axis];
        if (!(x < box.max_m[axis])) x = box.min_m[axis];
    }
    return position_m;
}

}  // namespace fts::physics
