// Rows of equal discs that fill a region: hexagonal rows, or square ones where these hold more,
// stretched so that they reach from side to side.
#pragma once

#include <cstddef>
#include <vector>

#include "common/physics/region.h"

namespace fts::physics {

// How many discs of this radius the best lattice holds.
std::size_t lattice_capacity(const Region& region, double radius_m);

// Where they are.
std::vector<Vec2d> lattice_places(const Region& region, double radius_m);

// The greatest radius of which a lattice holds `count` discs, by bisection; 0 when it finds none.
double lattice_radius_m(const Region& region, std::size_t count);

}  // namespace fts::physics
