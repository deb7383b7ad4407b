// Datagrams that wait to leave through a socket, in the order in which they came, so that many can
// leave in one call of the system. Knows what to do when the system takes only some of them, or
// none; knows no socket. Not thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "common/net/transport.h"

namespace fts::net {

// Room for a tick's snapshots of four arenas of 16; more leave before the tick's end. Linux takes
// at most 1024 in one call.
inline constexpr std::size_t kMaxWaitingDatagrams = 64;

class Outbox {
  public:
    struct Datagram {
        Address to;
        std::span<std::uint8_t> bytes;  // the system's interface asks for ones that are not const
    };
    // How far a call came: the first `sent` left, and unless all did, `error` (an errno) says why
    // the next one did not.
    struct Progress {
        std::size_t sent = 0;
        int error = 0;
    };
    using SendSome = std::function<Progress(std::span<const Datagram>)>;

    // `drops` outlives the outbox and has the names of drop::make_transport_counters.
    explicit Outbox(DropCounters& drops);

    bool empty() const { return count_ == 0; }
    bool full() const { return count_ == kMaxWaitingDatagrams; }
    // Copies a datagram of at most kMaxDatagramBytes. There must be room.
    void add(const Address& to, std::span<const std::uint8_t> bytes);

    // Sends until all have left or the system wants a pause (EAGAIN, ENOBUFS); what is left then
    // stays for the next time. A datagram that cannot be sent at all is dropped and counted. An
    // ECONNREFUSED speaks of an earlier datagram: it is counted, and the one in hand tried again.
    void send(const SendSome& send_some);

    std::uint64_t sent_count() const { return sent_count_; }
    std::uint64_t sent_bytes() const { return sent_bytes_; }

  private:
    using Slot = std::array<std::uint8_t, kMaxDatagramBytes>;
    void keep_from(std::size_t first);

    DropCounters& drops_;
    std::unique_ptr<Slot[]> slots_;
    std::array<Datagram, kMaxWaitingDatagrams> waiting_;  // whose bytes are in the slots
    std::size_t count_ = 0;
    std::uint64_t sent_count_ = 0;
    std::uint64_t sent_bytes_ = 0;
};

}  // namespace fts::net
