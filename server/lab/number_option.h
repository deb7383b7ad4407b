// What numbers on the command line are held to. Unlike CLI::Range, what is not a number is refused.
#pragma once

#include <sstream>
#include <string>

#include <CLI/CLI.hpp>

namespace fts::lab {

inline CLI::Validator number_from(double low, double high) {
    const auto check = [low, high](std::string& text) -> std::string {
        double value = 0.0;
        const bool is_number = CLI::detail::lexical_cast(text, value);
        if (is_number && value >= low && value <= high) return {};
        std::ostringstream message;
        message << text << " is not allowed; give a number from " << low << " to " << high;
        return message.str();
    };
    return {check, "NUMBER"};
}

}  // namespace fts::lab
