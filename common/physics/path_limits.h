// What grids of straight paths in single precision have in common (swept_paths.h, flight_paths.h).
#pragma once

#include <cstddef>
#include <limits>

namespace fts::physics {

// Who measures more than so many times what most do is a stray.
inline constexpr double kRadiiOfMost = 1.5;
// A grid has hardly more columns than bodies and these.
inline constexpr std::size_t kExtraCells = 16;

// Bodies that turn may become faster than those that start by so much, near the end of the span.
inline constexpr float kWayWhenTurned = 16.0F;

inline constexpr float kFloatEpsilon = std::numeric_limits<float>::epsilon();
// By how many units of its round-off a place may be wrong.
inline constexpr float kPlaceUnits = 4.0F;
// What that is at most for the square of a distance, in units of the longest one that matters.
inline constexpr float kSlackBlurs = 24.0F;

}  // namespace fts::physics
