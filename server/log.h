// Where the server says what happens, one line at a time. Who hosts it decides where lines go.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace fts::server {

enum class LogLevel : std::uint8_t { kDebug, kInfo, kWarning, kError };
using Log = std::function<void(LogLevel level, const std::string& line)>;

}  // namespace fts::server
