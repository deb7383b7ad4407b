// From what a ContactSet resolved to what a Record keeps.
#pragma once

#include <algorithm>
#include <span>

#include "common/physics/bodies.h"
#include "common/physics/record.h"
#include "common/physics/simultaneous.h"

namespace fts::physics {

// Appends the hits of one component, as `report` of ContactSet::resolve is given them, and adds
// them to the audit together. The positions of their bodies must be those of `time_s`.
template <typename Scalar>
void record_hits(const Bodies<Scalar>& bodies, Scalar time_s, std::span<const Hit<Scalar>> together,
                 Record<Scalar>& record);

// Depth of two discs in each other, in units of the smaller radius; 0 when they do not overlap.
template <typename Scalar>
inline Scalar penetration(Scalar distance_m, Scalar radius_1_m, Scalar radius_2_m) {
    const Scalar depth = std::max(Scalar(0), (radius_1_m + radius_2_m) - distance_m);
    return depth / std::min(radius_1_m, radius_2_m);
}

}  // namespace fts::physics
