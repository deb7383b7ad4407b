// A Transport that passes datagrams to another one through loss, delay, jitter, duplication and
// reordering, from a seed. Applies to both directions. What runs in tests, and behind
// `fts-bot --loss/--delay-ms/--jitter-ms`.
#pragma once

#include <memory>

#include "common/net/transport.h"

namespace fts::net {

struct LinkConditions {
    double loss = 0.0;       // probability, each way, [0, 1]
    double duplicate = 0.0;  // probability, each way, [0, 1]
    double delay_s = 0.0;    // each way
    double jitter_s = 0.0;   // uniform, +-, each way; makes datagrams overtake each other
    std::uint64_t seed = 1;
};

class SimulatedLink final : public Transport {
  public:
    SimulatedLink(std::unique_ptr<Transport> inner, const LinkConditions& conditions);
    ~SimulatedLink() override;
    // Held back until its time comes; `poll` is what moves datagrams on.
    bool send(const Address& to, std::span<const std::uint8_t> datagram) override;
    void flush() override;
    std::size_t poll(double now_s, const Receiver& receiver) override;
    DropCounters drops() const override;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fts::net
