#include "common/net/udp_calls.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <netinet/in.h>
#include <sys/socket.h>

namespace fts::net {

// Room for an address of either family, in the system's form.
struct SocketAddress {
    alignas(sockaddr_in6) std::array<std::byte, sizeof(sockaddr_in6)> bytes;

    sockaddr* any() { return static_cast<sockaddr*>(static_cast<void*>(bytes.data())); }
};
static_assert(sizeof(sockaddr_in6) >= sizeof(sockaddr_in));

namespace {

// Where the four bytes of a v4-mapped address are.
constexpr std::size_t kV4Begin = 12;

template <typename SystemAddress>
socklen_t put(const SystemAddress& address, SocketAddress& out) {
    std::memcpy(out.bytes.data(), &address, sizeof address);
    return sizeof address;
}

socklen_t write_address(const Address& address, bool is_v6, SocketAddress& out) {
    if (is_v6) {
        sockaddr_in6 v6{};
        v6.sin6_family = AF_INET6;
        v6.sin6_port = htons(address.port);
        std::memcpy(&v6.sin6_addr, address.ip.data(), sizeof v6.sin6_addr);
        return put(v6, out);
    }
    sockaddr_in v4{};
    v4.sin_family = AF_INET;
    v4.sin_port = htons(address.port);
    std::memcpy(&v4.sin_addr, &address.ip[kV4Begin], sizeof v4.sin_addr);
    return put(v4, out);
}

Address read_address(const SocketAddress& from) {
    Address address;
    sockaddr_in6 v6{};
    std::memcpy(&v6, from.bytes.data(), sizeof v6);
    if (v6.sin6_family == AF_INET6) {
        std::memcpy(address.ip.data(), &v6.sin6_addr, address.ip.size());
        address.port = ntohs(v6.sin6_port);
        return address;
    }
    sockaddr_in v4{};
    std::memcpy(&v4, from.bytes.data(), sizeof v4);
    address.ip[kV4Begin - 2] = address.ip[kV4Begin - 1] = 0xff;
    std::memcpy(&address.ip[kV4Begin], &v4.sin_addr, sizeof v4.sin_addr);
    address.port = ntohs(v4.sin_port);
    return address;
}

Outbox::Progress send_one(int socket, bool is_v6, const Outbox::Datagram& datagram) {
    SocketAddress to{};
    const socklen_t size = write_address(datagram.to, is_v6, to);
    const auto sent =
        ::sendto(socket, datagram.bytes.data(), datagram.bytes.size(), 0, to.any(), size);
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
    header.msg_hdr.msg_name = address.bytes.data();
    header.msg_hdr.msg_namelen = address_size;
}

Outbox::Progress send_many(int socket, bool is_v6, std::span<const Outbox::Datagram> datagrams) {
    std::array<mmsghdr, kMaxWaitingDatagrams> headers{};
    std::array<iovec, kMaxWaitingDatagrams> pieces{};
    std::array<SocketAddress, kMaxWaitingDatagrams> addresses{};
    const std::size_t count = std::min(datagrams.size(), headers.size());
    for (std::size_t i = 0; i < count; ++i) {
        const auto [to, bytes] = datagrams[i];
        const socklen_t size = write_address(to, is_v6, addresses[i]);
        describe(headers[i], pieces[i], bytes.data(), bytes.size(), addresses[i], size);
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
    const bool one = calls == UdpCalls::kOneByOne || datagrams.size() == 1;
    return one ? send_one(socket, is_v6, datagrams.front()) : send_many(socket, is_v6, datagrams);
}

struct ReceivedDatagrams::Buffers {
    // Not cleared: a page that no datagram needs is never touched.
    using Bytes = std::array<std::uint8_t, kReceiveBufferBytes>;
    std::unique_ptr<Bytes[]> bytes = std::make_unique_for_overwrite<Bytes[]>(kMaxReceivedAtOnce);
    std::array<SocketAddress, kMaxReceivedAtOnce> addresses{};
    std::array<std::size_t, kMaxReceivedAtOnce> sizes{};
#ifdef __linux__
    std::array<mmsghdr, kMaxReceivedAtOnce> headers{};
    std::array<iovec, kMaxReceivedAtOnce> pieces{};
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
                                     addresses[0].any(), &address_size);
        if (size < 0) return -1;
        sizes[0] = static_cast<std::size_t>(size);
        return 1;
    }
};

ReceivedDatagrams::ReceivedDatagrams() : buffers_(std::make_unique<Buffers>()) {}
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
