#include "common/net/udp_transport.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <poll.h>

#include <asio.hpp>

namespace fts::net {
namespace {

using asio::ip::udp;

// A flood must not keep `poll` from coming back.
constexpr std::size_t kMaxDatagramsPerPoll = 4096;
// Enough for a tick's worth of packets of a full server. The system may grant less.
constexpr int kSocketBufferBytes = 1 << 20;
// Larger ones are handed over cut, which is as good as any other way to be too large.
constexpr std::size_t kReceiveBufferBytes = 2048;
static_assert(kReceiveBufferBytes > kMaxDatagramBytes);

asio::error_code bind_to(udp::socket& socket, const udp::endpoint& endpoint) {
    asio::error_code error;
    asio::error_code ignored;
    socket.close(ignored);
    socket.open(endpoint.protocol(), error);
    if (error) return error;
    if (endpoint.protocol() == udp::v6()) {
        socket.set_option(asio::ip::v6_only(false), error);
        if (error) return error;
    }
    socket.set_option(asio::socket_base::receive_buffer_size(kSocketBufferBytes), ignored);
    socket.set_option(asio::socket_base::send_buffer_size(kSocketBufferBytes), ignored);
    socket.bind(endpoint, error);
    if (error) return error;
    socket.non_blocking(true, error);
    return error;
}

std::string explain(const asio::error_code& error, const std::string& host, std::uint16_t port) {
    const std::string udp_port = "UDP port " + std::to_string(port);
    if (error == asio::error::address_in_use) {
        return udp_port + " is in use; stop the other server or choose another with --port";
    }
    if (error == asio::error::access_denied) {
        return udp_port + " may not be used by this user; choose one above 1023 with --port";
    }
    return "cannot open " + udp_port + (host.empty() ? "" : " on '" + host + "'") + ": " +
           error.message() + "; choose an address of this machine, or none for all of them";
}

Address address_of(const udp::endpoint& endpoint) {
    const auto v6 = endpoint.address().is_v4()
                        ? asio::ip::make_address_v6(asio::ip::v4_mapped, endpoint.address().to_v4())
                        : endpoint.address().to_v6();
    return {v6.to_bytes(), endpoint.port()};
}

}  // namespace

struct UdpTransport::Impl {
    asio::io_context context;
    udp::socket socket{context};
    std::array<std::uint8_t, kReceiveBufferBytes> buffer{};
};

std::unique_ptr<UdpTransport> UdpTransport::open(const std::string& bind_host, std::uint16_t port,
                                                 std::string& error) {
    auto impl = std::make_unique<Impl>();
    asio::error_code failure;
    if (bind_host.empty()) {
        failure = bind_to(impl->socket, {udp::v6(), port});
        const bool is_v6_missing = failure == asio::error::address_family_not_supported ||
                                   failure == asio::error::no_protocol_option ||
                                   failure == std::errc::address_not_available;
        if (is_v6_missing) failure = bind_to(impl->socket, {udp::v4(), port});
    } else {
        udp::resolver resolver(impl->context);
        const auto results = resolver.resolve(bind_host, "", failure);
        for (const auto& result : results) {
            failure = bind_to(impl->socket, {result.endpoint().address(), port});
            if (!failure) break;
        }
    }
    if (failure) {
        error = explain(failure, bind_host, port);
        return nullptr;
    }
    return std::unique_ptr<UdpTransport>(new UdpTransport(std::move(impl)));
}

UdpTransport::UdpTransport(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
UdpTransport::~UdpTransport() = default;

std::uint16_t UdpTransport::local_port() const {
    asio::error_code error;
    return impl_->socket.local_endpoint(error).port();
}

bool UdpTransport::send(const Address& to, std::span<const std::uint8_t> datagram) {
    if (datagram.size() > kMaxDatagramBytes) return false;
    asio::error_code error;
    asio::ip::address address = asio::ip::address_v6(to.ip);
    if (impl_->socket.local_endpoint(error).protocol() == udp::v4()) {
        if (!address.to_v6().is_v4_mapped()) return false;
        address = asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
    }
    impl_->socket.send_to(asio::buffer(datagram.data(), datagram.size()), {address, to.port}, 0,
                          error);
    return !error;
}

std::size_t UdpTransport::poll(double /*now_s*/, const Receiver& receiver) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kMaxDatagramsPerPoll; ++i) {
        udp::endpoint from;
        asio::error_code error;
        const std::size_t size =
            impl_->socket.receive_from(asio::buffer(impl_->buffer), from, 0, error);
        if (error == asio::error::would_block || error == asio::error::try_again) break;
        if (error) continue;  // an unreachable peer is reported here; silence tells as much
        ++count;
        receiver(address_of(from), std::span(impl_->buffer).first(size));
    }
    return count;
}

void UdpTransport::wait_readable(double timeout_s) {
    pollfd descriptor{impl_->socket.native_handle(), POLLIN, 0};
    const double timeout_ms = std::clamp(std::ceil(timeout_s * 1e3), 0.0, 60e3);
    ::poll(&descriptor, 1, static_cast<int>(timeout_ms));
}

}  // namespace fts::net
