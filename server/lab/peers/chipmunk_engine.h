// Chipmunk 7 set up for elastic discs as well as it can be: elasticity 1, no friction, no rotation,
// no damping, no sleep, 10 iterations, and a collision slop of a thousandth of a radius instead of
// its default, a fifth of one at this size.
#pragma once

#include <memory>

#include "server/lab/bench/engine.h"

namespace fts::lab {

// The hash has cells of the largest diameter and ten of them a ball, as its manual advises.
enum class ChipmunkIndex : std::uint8_t { kSpatialHash, kBoxTree };

std::unique_ptr<Engine> make_chipmunk(const physics::Scene& scene, double tick_s,
                                      ChipmunkIndex index);

}  // namespace fts::lab
