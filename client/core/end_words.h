// Why a session ended, as a sentence for a person, with a remedy.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/net/connection.h"

namespace fts::client {

// `own_version` is the protocol version this end spoke; `what.detail` may hold anything.
std::string words_for(const net::Disconnected& what, const net::Address& server,
                      std::uint16_t own_version, double timeout_s);

// Text from outside, fit for a terminal or a screen: control characters become '?', and it is cut
// to `max_bytes`.
std::string printable(std::string_view text, std::size_t max_bytes);

}  // namespace fts::client
