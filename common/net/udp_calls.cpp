#include "common/net/udp_calls.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <netinet/in.h>
#include <sys/socket.h>

namespace fts::net {

union SocketAddress {
    sockaddr_in6 v6;  // the largest first, so that {} clears all
    sockaddr_in v4;
    sockaddr any;
};

namespace {

// Where the four bytes of a v4-mapped address are.
constexpr std::size_t kV4Begin = 12;

socklen_t write_address(const Address& address, bool is_v6, SocketAddress& out) {
    out = {};
    if (is_v6) {
        out.v6.sin6_family = AF_INET6;
        out.v6.sin6_port = htons(address.port);
        std::memcpy(&out.v6.sin6_addr, address.ip.data(), sizeof out.v6.sin6_addr);
        return sizeof out.v6;
    }
    out.v4.sin_family = AF_INET;
    out.v4.sin_port = htons(address.port);
    std::memcpy(&out.v4.sin_addr, &address.ip[kV4Begin], sizeof out.v4.sin_addr);
    return sizeof out.v4;
}

Address read_address(const SocketAddress& from) {
    Address address;
    if (from.any.sa_family == AF_INET6) {
        std::memcpy(address.ip.data(), &from.v6.sin6_addr, address.ip.size());
        address.port = ntohs(from.v6.sin6_port);
        return address;
    }
    address.ip[kV4Begin - 2] = address.ip[kV4Begin - 1] = 0xff;
    std::memcpy(&address.ip[kV4Begin], &from.v4.sin_addr, sizeof from.v4.sin_addr);
    address.port = ntohs(from.v4.sin_port);
    return address;
}

Outbox::Progress send_one(int socket, bool is_v6, const Outbox::Datagram& datagram) {
    SocketAddress to;
    const socklen_t size = write_address(datagram.to, is_v6, to);
    const auto sent =
        ::sendto(socket, datagram.bytes.data(), datagram.bytes.size(), 0, &to.any, size);
    return sent < 0 ? Outbox::Progress{0, errno} : Outbox::Progress{1, 0};
}

#ifdef __linux__

// The system's header for one message, over bytes that stay the caller's.
void describe(mmsghdr& header, iovec& piece, void* bytes, std::size_t size, SocketAddress& address,
              socklen_t address_size) {
    piece = {bytes, size};
    header = {};
    header.msg_hdr.msg_iov = &piece;
    header.msg_hdr.msg_iovlen = 1;
    header.msg_hdr.msg_name = &address;
    header.msg_hdr.msg_namelen = address_size;
}

Outbox::Progress send_many(int socket, bool is_v6, std::span<const Outbox::Datagram> datagrams) {
    std::array<mmsghdr, kMaxWaitingDatagrams> headers;
    std::array<iovec, kMaxWaitingDatagrams> pieces;
    std::array<SocketAddress, kMaxWaitingDatagrams> addresses;
    const std::size_t count = std::min(datagrams.size(), headers.size());
    for (std::size_t i = 0; i < count; ++i) {
        const auto [to, bytes] = datagrams[i];
        const socklen_t size = write_address(to, is_v6, addresses[i]);
        // The system only reads what it sends; its interface does not say so.
        auto* start = const_cast<std::uint8_t*>(bytes.data());
        describe(headers[i], pieces[i], start, bytes.size(), addresses[i], size);
    }
    const int sent = ::sendmmsg(socket, headers.data(), static_cast<unsigned>(count), 0);
    // Of a failure after the first it says nothing: that comes again with the next call.
    return sent < 0 ? Outbox::Progress{0, errno}
                    : Outbox::Progress{static_cast<std::size_t>(sent), 0};
}

#else

Outbox::Progress send_many(int socket, bool is_v6, std::span<const Outbox::Datagram> datagrams) {
    return send_one(socket, is_v6, datagrams.front());
}

#endif

}  // namespace

Outbox::Progress send_some(int socket, bool is_v6, UdpCalls calls,
                           std::span<const Outbox::Datagram> datagrams) {
    return calls == UdpCalls::kOneByOne ? send_one(socket, is_v6, datagrams.front())
                                        : send_many(socket, is_v6, datagrams);
}

struct ReceivedDatagrams::Buffers {
    std::array<std::array<std::uint8_t, kReceiveBufferBytes>, kMaxReceivedAtOnce> bytes;
    std::array<SocketAddress, kMaxReceivedAtOnce> addresses;
    std::array<std::size_t, kMaxReceivedAtOnce> sizes;
#ifdef __linux__
    std::array<mmsghdr, kMaxReceivedAtOnce> headers;
    std::array<iovec, kMaxReceivedAtOnce> pieces;
    std::size_t undescribed = kMaxReceivedAtOnce;  // the first so many headers are to be written

    int receive_many(int socket) {
        for (std::size_t i = 0; i < undescribed; ++i) {
            describe(headers[i], pieces[i], bytes[i].data(), bytes[i].size(), addresses[i],
                     sizeof addresses[i]);
        }
        const int count =
            ::recvmmsg(socket, headers.data(), kMaxReceivedAtOnce, MSG_DONTWAIT, nullptr);
        undescribed = static_cast<std::size_t>(std::max(count, 0));
        for (std::size_t i = 0; i < undescribed; ++i) sizes[i] = headers[i].msg_len;
        return count;
    }
#else
    int receive_many(int socket) {
        return receive_one(socket);
    }
#endif

    int receive_one(int socket) {
        socklen_t address_size = sizeof addresses[0];
        const auto size = ::recvfrom(socket, bytes[0].data(), bytes[0].size(), MSG_DONTWAIT,
                                     &addresses[0].any, &address_size);
        if (size < 0) return -1;
        sizes[0] = static_cast<std::size_t>(size);
        return 1;
    }
};

// Not cleared: a page that no datagram needs is never touched.
ReceivedDatagrams::ReceivedDatagrams() : buffers_(std::make_unique_for_overwrite<Buffers>()) {}
ReceivedDatagrams::~ReceivedDatagrams() = default;

ReceivedDatagrams::Outcome ReceivedDatagrams::receive(int socket, UdpCalls calls) {
    const bool one_by_one = calls == UdpCalls::kOneByOne;
    const int count = one_by_one ? buffers_->receive_one(socket) : buffers_->receive_many(socket);
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return {0, true, 0};
    if (count < 0) return {0, false, errno};
#ifdef __linux__
    const bool is_drained = !one_by_one && count < static_cast<int>(kMaxReceivedAtOnce);
#else
    const bool is_drained = false;
#endif
    return {static_cast<std::size_t>(count), is_drained, 0};
}

Address ReceivedDatagrams::from(std::size_t index) const {
    return read_address(buffers_->addresses[index]);
}

std::span<const std::uint8_t> ReceivedDatagrams::bytes(std::size_t index) const {
    return std::span(buffers_->bytes[index]).first(buffers_->sizes[index]);
}

std::uint64_t overflow_count(int socket) {
#ifdef SO_MEMINFO
    // SK_MEMINFO_DROPS of linux/sock_diag.h is the last of nine.
    std::array<std::uint32_t, 9> memory{};
    socklen_t size = sizeof memory;
    const bool known = ::getsockopt(socket, SOL_SOCKET, SO_MEMINFO, memory.data(), &size) == 0;
    return known && size == sizeof memory ? memory.back() : 0;
#else
    static_cast<void>(socket);
    return 0;
#endif
}

}  // namespace fts::net
