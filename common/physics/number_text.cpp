#include "common/physics/number_text.h"

#include <charconv>

namespace fts::physics {

std::string text_of(double value) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string text_of(const Vec2d& value) {
    return "(" + text_of(value.x()) + ", " + text_of(value.y()) + ")";
}

}  // namespace fts::physics
