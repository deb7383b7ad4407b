// Places for discs inside a region so that none overlap. Pure and deterministic.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "common/physics/region.h"
#include "common/physics/splitmix.h"

namespace fts::physics {

// A place for each radius, clear of each other and of the obstacles, which are part of the scene
// already. Empty when it finds none. The radii have passed `validate`.
std::optional<std::vector<Vec2d>> pack(const Region& region, std::span<const double> radii_m,
                                       std::span<const BodyDef> obstacles, SplitMix& random);

}  // namespace fts::physics
