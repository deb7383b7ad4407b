#include "common/net/transport.h"

#include <algorithm>
#include <charconv>

#include <asio.hpp>

namespace fts::net {
namespace {

struct HostAndPort {
    std::string host;
    std::string port;  // empty: not given
};

// "[v6]:port", "[v6]", "v6" (which has several colons), "host:port", "host".
std::optional<HostAndPort> split(std::string_view text) {
    if (text.starts_with('[')) {
        const std::size_t bracket = text.find(']');
        if (bracket == std::string_view::npos) return std::nullopt;
        const std::string_view rest = text.substr(bracket + 1);
        if (!rest.empty() && (rest.front() != ':' || rest.size() == 1)) return std::nullopt;
        return HostAndPort{std::string(text.substr(1, bracket - 1)),
                           std::string(rest.empty() ? rest : rest.substr(1))};
    }
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos || text.find(':', colon + 1) != std::string_view::npos) {
        return HostAndPort{std::string(text), ""};
    }
    if (colon + 1 == text.size()) return std::nullopt;
    return HostAndPort{std::string(text.substr(0, colon)), std::string(text.substr(colon + 1))};
}

std::optional<std::uint16_t> parse_port(std::string_view text) {
    std::uint16_t port = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
    if (error != std::errc{} || end != text.data() + text.size() || port == 0) return std::nullopt;
    return port;
}

std::array<std::uint8_t, 16> v6_form(const asio::ip::address& address) {
    const auto v6 = address.is_v4()
                        ? asio::ip::make_address_v6(asio::ip::v4_mapped, address.to_v4())
                        : address.to_v6();
    return v6.to_bytes();
}

}  // namespace

std::string to_string(const Address& address) {
    const asio::ip::address_v6 v6(address.ip);
    const std::string port = ":" + std::to_string(address.port);
    if (v6.is_v4_mapped()) {
        return asio::ip::make_address_v4(asio::ip::v4_mapped, v6).to_string() + port;
    }
    return "[" + v6.to_string() + "]" + port;
}

bool is_loopback(const Address& address) {
    const asio::ip::address_v6 v6(address.ip);
    return v6.is_v4_mapped() ? asio::ip::make_address_v4(asio::ip::v4_mapped, v6).is_loopback()
                             : v6.is_loopback();
}

Resolved resolve(std::string_view host_and_port, std::uint16_t default_port) {
    const std::string quoted = "'" + std::string(host_and_port) + "'";
    std::optional<HostAndPort> parts = split(host_and_port);
    if (!parts || parts->host.empty()) {
        return {std::nullopt, quoted + " is not an address; write host, host:port or [ipv6]:port"};
    }
    std::uint16_t port = default_port;
    if (!parts->port.empty()) {
        const std::optional<std::uint16_t> given = parse_port(parts->port);
        if (!given) {
            return {std::nullopt, "the port '" + parts->port + "' in " + quoted +
                                      " is not a number from 1 to 65535"};
        }
        port = *given;
    }
    // RFC 6761: never a question for a name server, and a bare system may have no hosts file.
    if (parts->host == "localhost") parts->host = "127.0.0.1";
    asio::io_context context;
    asio::ip::udp::resolver resolver(context);
    asio::error_code error;
    const auto results = resolver.resolve(parts->host, "", error);
    if (error || results.empty()) {
        return {std::nullopt, "cannot find the host '" + parts->host + "' (" + error.message() +
                                  "); check its spelling and your network, or give its IP address"};
    }
    // IPv4 first: a server may be without IPv6, hardly ever without IPv4.
    auto chosen = std::find_if(results.begin(), results.end(), [](const auto& result) {
        return result.endpoint().address().is_v4();
    });
    if (chosen == results.end()) chosen = results.begin();
    return {Address{v6_form(chosen->endpoint().address()), port}, ""};
}

}  // namespace fts::net
