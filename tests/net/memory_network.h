// Datagrams without sockets: transports that reach each other through memory, in order and at once.
// Whatever is sent is also kept, so that a test can look at it, alter it and send it again.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "common/net/transport.h"

namespace fts::net {

using Datagram = std::vector<std::uint8_t>;

struct Sniffed {
    Address from, to;
    Datagram bytes;
};

class MemoryNetwork {
  public:
    void deliver(const Address& from, const Address& to, std::span<const std::uint8_t> bytes) {
        const Datagram datagram(bytes.begin(), bytes.end());
        sent.push_back({from, to, datagram});
        if (!is_cut) arrived_[to].emplace_back(from, datagram);
    }
    std::deque<std::pair<Address, Datagram>>& inbox(const Address& owner) {
        return arrived_[owner];
    }

    std::vector<Sniffed> sent;
    bool is_cut = false;  // when set, everything is lost

  private:
    std::map<Address, std::deque<std::pair<Address, Datagram>>> arrived_;
};

class MemoryTransport final : public Transport {
  public:
    MemoryTransport(MemoryNetwork& network, const Address& own) : network_(network), own_(own) {}

    bool send(const Address& to, std::span<const std::uint8_t> datagram) override {
        if (datagram.size() > kMaxDatagramBytes) return false;
        network_.deliver(own_, to, datagram);
        return true;
    }
    std::size_t poll(double /*now_s*/, const Receiver& receiver) override {
        auto& inbox = network_.inbox(own_);
        std::size_t count = 0;
        for (; !inbox.empty(); ++count) {
            const auto [from, bytes] = std::move(inbox.front());
            inbox.pop_front();
            receiver(from, bytes);
        }
        return count;
    }
    void move_to(const Address& address) { own_ = address; }

  private:
    MemoryNetwork& network_;
    Address own_;
};

// 10.0.0.host:port in v4-mapped form.
inline Address address_of(std::uint8_t host, std::uint16_t port = 7777) {
    return {{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 10, 0, 0, host}, port};
}

}  // namespace fts::net
