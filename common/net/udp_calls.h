// The calls of the system that move datagrams through a socket: many in one where there are
// sendmmsg and recvmmsg (Linux), one by one elsewhere or when asked. Of udp_transport.cpp only.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "common/net/outbox.h"
#include "common/net/transport.h"
#include "common/net/udp_transport.h"

namespace fts::net {

// What one call receives at most.
inline constexpr std::size_t kMaxReceivedAtOnce = 64;
// Larger datagrams are handed over cut, which is as good as any other way to be too large.
inline constexpr std::size_t kReceiveBufferBytes = 2048;
static_assert(kReceiveBufferBytes > kMaxDatagramBytes);

// The socket is non-blocking; on one of IPv4 all addresses are v4-mapped ones.
Outbox::Progress send_some(int socket, bool is_v6, UdpCalls calls,
                           std::span<const Outbox::Datagram> datagrams);

class ReceivedDatagrams {
  public:
    ReceivedDatagrams();
    ~ReceivedDatagrams();

    struct Outcome {
        std::size_t count = 0;
        bool is_drained = false;  // nothing was left
        int error = 0;            // an errno; nothing was received then
    };
    // Takes what has arrived in place of what it held.
    Outcome receive(int socket, UdpCalls calls);
    Address from(std::size_t index) const;
    std::span<const std::uint8_t> bytes(std::size_t index) const;

  private:
    struct Buffers;
    std::unique_ptr<Buffers> buffers_;
};

// How many datagrams the system has thrown away because nobody received them in time; nothing where
// it does not tell.
std::uint64_t overflow_count(int socket);

}  // namespace fts::net
