#include "common/net/half_open.h"

#include <algorithm>

namespace fts::net {
namespace {

// The part of an address that one customer of a network has to itself.
std::array<std::uint8_t, 16> host_of(const Address& address) {
    constexpr std::array<std::uint8_t, 12> kMapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};
    auto host = address.ip;
    if (!std::equal(kMapped.begin(), kMapped.end(), host.begin())) {
        std::fill(host.begin() + 8, host.end(), std::uint8_t{0});
    }
    return host;
}

}  // namespace

bool HalfOpenTable::has_room_for(const Address& address) const {
    const auto from_same_host = std::count_if(table_.begin(), table_.end(),
                                              [host = host_of(address)](const HalfOpen& other) {
                                                  return host_of(other.address) == host;
                                              });
    return table_.size() < kMaxHalfOpen &&
           static_cast<std::size_t>(from_same_host) < kMaxHalfOpenPerHost;
}

HalfOpen& HalfOpenTable::add(HalfOpen half_open) {
    table_.push_back(std::move(half_open));
    return table_.back();
}

HalfOpen* HalfOpenTable::find(const Address& address, const EphemeralKey& ephemeral) {
    const auto found = std::find_if(table_.begin(), table_.end(), [&](const HalfOpen& half_open) {
        return half_open.address == address && half_open.ephemeral == ephemeral;
    });
    return found == table_.end() ? nullptr : &*found;
}

HalfOpen* HalfOpenTable::find(ConnectionId id) {
    const auto found = std::find_if(table_.begin(), table_.end(),
                                    [&](const HalfOpen& half_open) { return half_open.id == id; });
    return found == table_.end() ? nullptr : &*found;
}

void HalfOpenTable::remove(ConnectionId id) {
    table_.remove_if([&](const HalfOpen& half_open) { return half_open.id == id; });
}

void HalfOpenTable::expire(double now_s) {
    table_.remove_if([&](const HalfOpen& half_open) {
        return now_s - half_open.begun_at_s > kHalfOpenTimeoutS;
    });
}

}  // namespace fts::net
