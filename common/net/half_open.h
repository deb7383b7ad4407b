// Handshakes that a server has begun and a client has not finished: few, short-lived, and not many
// from one place. Time is passed in.
#pragma once

#include <cstdint>
#include <list>

#include "common/net/handshake.h"
#include "common/net/noise.h"

namespace fts::net {

inline constexpr std::size_t kMaxHalfOpen = 256;
// From one IPv4 address or one IPv6 /64, so that a single one cannot keep the others out.
inline constexpr std::size_t kMaxHalfOpenPerHost = 64;
inline constexpr double kHalfOpenTimeoutS = 3.0;
static_assert(kMaxHalfOpenPerHost < kMaxHalfOpen);

struct HalfOpen {
    ConnectionId id = 0;
    Address address;
    EphemeralKey ephemeral{};  // the client's, which names its attempt
    NoiseXX noise;
    Datagram response;  // sent again whenever the client asks again
    double begun_at_s = 0.0;
};

class HalfOpenTable {
  public:
    bool has_room_for(const Address& address) const;
    HalfOpen& add(HalfOpen half_open);
    // Null when there is none. Pointers hold until the next call that is not const.
    HalfOpen* find(const Address& address, const EphemeralKey& ephemeral);
    HalfOpen* find(ConnectionId id);
    void remove(ConnectionId id);
    void expire(double now_s);
    std::size_t size() const { return table_.size(); }

  private:
    std::list<HalfOpen> table_;  // oldest first
};

}  // namespace fts::net
