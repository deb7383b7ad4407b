#include "client/core/endpoint.h"

#include "common/game/rules.h"
#include "common/net/udp_transport.h"

namespace fts::client {

std::unique_ptr<net::Transport> open_endpoint(const std::optional<net::LinkConditions>& conditions,
                                              std::string& error) {
    std::unique_ptr<net::Transport> socket = net::UdpTransport::open("", 0, error);
    if (!socket || !conditions) return socket;
    return std::make_unique<net::SimulatedLink>(std::move(socket), *conditions);
}

net::Resolved resolve_server(std::string_view host_and_port) {
    return net::resolve(host_and_port, game::kDefaultPort);
}

}  // namespace fts::client
