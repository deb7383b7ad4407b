// One non-blocking UDP socket (Asio, in the .cpp only). Dual-stack where the system allows it, IPv4
// otherwise. What is sent waits for `flush`, `poll` or a full outbox (outbox.h), so that a tick's
// datagrams leave in few calls of the system. Not thread-safe.
#pragma once

#include <memory>
#include <string>

#include "common/net/transport.h"

namespace fts::net {

// Where the system can move many datagrams with one call (Linux), or one with each.
enum class UdpCalls : std::uint8_t { kBatched, kOneByOne };

struct UdpStats {
    std::uint64_t datagrams_sent = 0, bytes_sent = 0, send_calls = 0;
    std::uint64_t datagrams_received = 0, bytes_received = 0,
                  receive_calls = 0;  // calls that found nothing as well
};

class UdpTransport final : public Transport {
  public:
    // `bind_host` empty: every interface. Port 0: any free port. On failure returns nullptr and
    // sets `error` to a message that names port and remedy ("UDP port 7777 is in use; ...").
    static std::unique_ptr<UdpTransport> open(const std::string& bind_host, std::uint16_t port,
                                              std::string& error,
                                              UdpCalls calls = UdpCalls::kBatched);
    // Flushes.
    ~UdpTransport() override;

    std::uint16_t local_port() const;

    bool send(const Address& to, std::span<const std::uint8_t> datagram) override;
    void flush() override;
    // Flushes, too: who forgets to is late, not silent.
    std::size_t poll(double now_s, const Receiver& receiver) override;
    DropCounters drops() const override;
    UdpStats stats() const;
    // Blocks until a datagram may be waiting or `timeout_s` has passed.
    void wait_readable(double timeout_s);

  private:
    struct Impl;
    explicit UdpTransport(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace fts::net
