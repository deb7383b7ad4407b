// One player's own UDP socket, as the programs open it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/net/simulated_link.h"
#include "common/net/transport.h"

namespace fts::client {

// Any free port on every interface; with `conditions`, behind a simulated bad network. nullptr with
// `error` set.
std::unique_ptr<net::Transport> open_endpoint(const std::optional<net::LinkConditions>& conditions,
                                              std::string& error);

// "host", "host:port" or "[v6]:port"; the game's port unless another one is given.
net::Resolved resolve_server(std::string_view host_and_port);

}  // namespace fts::client
