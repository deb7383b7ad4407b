// A number as the shortest text that reads back as the same number.
#pragma once

#include <string>

#include "common/physics/body.h"

namespace fts::physics {

std::string text_of(double value);
std::string text_of(const Vec2d& value);  // "(x, y)"

}  // namespace fts::physics
