#include "common/net/udp_transport.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <poll.h>

#include <asio.hpp>

#include "common/net/drops.h"
#include "common/net/outbox.h"
#include "common/net/udp_calls.h"

namespace fts::net {
namespace {

using asio::ip::udp;

// A flood must not keep `poll` from coming back.
constexpr std::size_t kMaxDatagramsPerPoll = 4096;
// Enough for a tick's worth of packets of a full server. The system may grant less.
constexpr int kSocketBufferBytes = 1 << 20;
// Errors in a row after which `poll` comes back, whatever else is waiting.
constexpr int kMaxErrorsPerPoll = 64;

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

bool is_v4_mapped(const Address& address) {
    return asio::ip::address_v6(address.ip).is_v4_mapped();
}

}  // namespace

struct UdpTransport::Impl {
    void flush();

    asio::io_context context;
    udp::socket socket{context};
    UdpCalls calls = UdpCalls::kBatched;
    bool is_v6 = true;
    DropCounters drops = drop::make_transport_counters();
    Outbox outbox{drops};
    ReceivedDatagrams received;
    UdpStats stats;
};

void UdpTransport::Impl::flush() {
    if (outbox.empty()) return;
    outbox.send([this](std::span<const Outbox::Datagram> datagrams) {
        ++stats.send_calls;
        return send_some(socket.native_handle(), is_v6, calls, datagrams);
    });
}

std::unique_ptr<UdpTransport> UdpTransport::open(const std::string& bind_host, std::uint16_t port,
                                                 std::string& error, UdpCalls calls) {
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
    impl->calls = calls;
    impl->is_v6 = impl->socket.local_endpoint(failure).protocol() == udp::v6();
    return std::unique_ptr<UdpTransport>(new UdpTransport(std::move(impl)));
}

UdpTransport::UdpTransport(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
UdpTransport::~UdpTransport() {
    impl_->flush();
}

std::uint16_t UdpTransport::local_port() const {
    asio::error_code error;
    return impl_->socket.local_endpoint(error).port();
}

bool UdpTransport::send(const Address& to, std::span<const std::uint8_t> datagram) {
    Impl& impl = *impl_;
    const auto dropped = [&impl](std::string_view reason) {
        ++impl.drops[reason];
        return false;
    };
    if (datagram.size() > kMaxDatagramBytes) return dropped(drop::kSendTooLarge);
    if (!impl.is_v6 && !is_v4_mapped(to)) return dropped(drop::kSendUnroutable);
    if (impl.outbox.full()) impl.flush();
    if (impl.outbox.full()) return dropped(drop::kSendBufferFull);
    impl.outbox.add(to, datagram);
    return true;
}

void UdpTransport::flush() {
    impl_->flush();
}

std::size_t UdpTransport::poll(double /*now_s*/, const Receiver& receiver) {
    Impl& impl = *impl_;
    impl.flush();
    std::size_t count = 0;
    int errors = 0;
    while (count < kMaxDatagramsPerPoll && errors < kMaxErrorsPerPoll) {
        ++impl.stats.receive_calls;
        const auto outcome = impl.received.receive(impl.socket.native_handle(), impl.calls);
        if (outcome.error != 0) {
            ++errors;
            if (outcome.error == ECONNREFUSED) {
                ++impl.drops[drop::kPeerUnreachable];
            } else if (outcome.error != EINTR) {
                ++impl.drops[drop::kReceiveFailed];
            }
        }
        for (std::size_t i = 0; i < outcome.count; ++i) {
            impl.stats.bytes_received += impl.received.bytes(i).size();
            receiver(impl.received.from(i), impl.received.bytes(i));
        }
        count += outcome.count;
        if (outcome.is_drained) break;
    }
    impl.stats.datagrams_received += count;
    return count;
}

DropCounters UdpTransport::drops() const {
    DropCounters drops = impl_->drops;
    drops[drop::kReceiveBufferFull] += overflow_count(impl_->socket.native_handle());
    return drops;
}

UdpStats UdpTransport::stats() const {
    UdpStats stats = impl_->stats;
    stats.datagrams_sent = impl_->outbox.sent_count();
    stats.bytes_sent = impl_->outbox.sent_bytes();
    return stats;
}

void UdpTransport::wait_readable(double timeout_s) {
    pollfd descriptor{impl_->socket.native_handle(), POLLIN, 0};
    const double timeout_ms = std::clamp(std::ceil(timeout_s * 1e3), 0.0, 60e3);
    ::poll(&descriptor, 1, static_cast<int>(timeout_ms));
}

}  // namespace fts::net
