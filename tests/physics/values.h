// Numbers that many tests speak of.
#pragma once

#include <limits>

namespace fts::physics {

inline constexpr double kTick = 1.0 / 60.0;  // s
inline constexpr double kInfinite = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace fts::physics
