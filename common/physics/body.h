// What the world says of a body, and what may be asked of it.
#pragma once

#include <compare>
#include <cstdint>

#include "common/physics/scene.h"

namespace fts::physics {

struct BodyId {
    std::uint32_t index = 0;
    std::uint32_t generation = 0;
    friend auto operator<=>(const BodyId&, const BodyId&) = default;
};

// What accelerates a body during a kick: dv/dt = acceleration - drag * v.
template <typename Scalar>
struct Control {
    Vec2<Scalar> acceleration_mps2 = Vec2<Scalar>::Zero();
    Scalar drag_per_s = Scalar(0);  // >= 0; terminal speed is |acceleration| / drag

    bool acts() const {
        return drag_per_s != Scalar(0) || acceleration_mps2.x() != Scalar(0) ||
               acceleration_mps2.y() != Scalar(0);
    }
};

template <typename Scalar>
struct BodyView {
    BodyId id;
    Vec2<Scalar> position_m;
    Vec2<Scalar> velocity_mps;
    Scalar radius_m;
    Scalar mass_kg;
};

}  // namespace fts::physics
