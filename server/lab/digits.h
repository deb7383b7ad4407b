// A number as text, in so many digits.
#pragma once

#include <cstdio>
#include <string>

namespace fts::lab {

// `format` has one conversion, of a double, and gives fewer than 32 characters; what is longer is
// cut.
inline std::string with_digits(const char* format, double value) {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

}  // namespace fts::lab
