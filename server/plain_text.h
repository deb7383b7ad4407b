// Text that strangers sent, made fit for other people's screens and for the log.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fts::server {

// Keeps the valid UTF-8 and leaves out everything that is not, control characters, and characters
// that are invisible or turn the direction of writing. Trims spaces at both ends, and cuts between
// two characters to at most `max_bytes`.
std::string plain_line(std::string_view text, std::size_t max_bytes);

}  // namespace fts::server
