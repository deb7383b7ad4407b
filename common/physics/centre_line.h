// The line along which two overlapping discs collide and are parted.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/physics/scene.h"

namespace fts::physics {

// From the second to the first; never of length 0.
template <typename Scalar>
struct CentreLine {
    Scalar x, y;
    Scalar squared, length;
    Scalar distance_m;  // of the centres; the line's length, unless they coincide
};

// Centres that coincide have the line of their relative velocity, and at rest that along x. Below
// the least distance whose square keeps all its digits, centres coincide.
template <typename Scalar>
[[gnu::always_inline]] inline CentreLine<Scalar> centre_line(const Vec2<Scalar>& separation_m,
                                                             const Vec2<Scalar>& velocity_a_mps,
                                                             const Vec2<Scalar>& velocity_b_mps) {
    constexpr Scalar kCoincident =
        std::numeric_limits<Scalar>::min() / std::numeric_limits<Scalar>::epsilon();
    Scalar x = separation_m.x(), y = separation_m.y();
    Scalar squared = x * x + y * y;
    if (squared > kCoincident) {
        const Scalar length = std::sqrt(squared);
        return {x, y, squared, length, length};
    }
    x = velocity_b_mps.x() - velocity_a_mps.x();
    y = velocity_b_mps.y() - velocity_a_mps.y();
    const Scalar larger = std::max(std::abs(x), std::abs(y));
    if (!(larger > Scalar(0))) return {Scalar(1), Scalar(0), Scalar(1), Scalar(1), Scalar(0)};
    x /= larger;
    y /= larger;
    squared = x * x + y * y;
    return {x, y, squared, std::sqrt(squared), Scalar(0)};
}

}  // namespace fts::physics
