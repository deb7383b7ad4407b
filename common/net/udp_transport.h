// One non-blocking UDP socket (Asio, in the .cpp only). Dual-stack where the system allows it, IPv4
// otherwise. Not thread-safe.
#pragma once

#include <memory>
#include <string>

#include "common/net/transport.h"

namespace fts::net {

class UdpTransport final : public Transport {
  public:
    // `bind_host` empty: every interface. Port 0: any free port. On failure returns nullptr and
    // sets `error` to a message that names port and remedy ("UDP port 7777 is in use; ...").
    static std::unique_ptr<UdpTransport> open(const std::string& bind_host, std::uint16_t port,
                                              std::string& error);
    ~UdpTransport() override;

    std::uint16_t local_port() const;

    bool send(const Address& to, std::span<const std::uint8_t> datagram) override;
    std::size_t poll(double now_s, const Receiver& receiver) override;
    // Blocks until a datagram may be waiting or `timeout_s` has passed.
    void wait_readable(double timeout_s);

  private:
    struct Impl;
    explicit UdpTransport(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace fts::net
