// Packet numbers: which were seen, and how a number that travels as its low 32 bits is made whole
// again.
#pragma once

#include <bitset>
#include <cstdint>

namespace fts::net {

// How far a packet may be overtaken and still be taken.
inline constexpr std::size_t kReplayWindowPackets = 1024;
// How many packets before the newest one acknowledgement speaks of.
inline constexpr std::size_t kAckBits = 64;
static_assert(kReplayWindowPackets > kAckBits);

// The number nearest to `reference` whose low 32 bits are `low`, never below 0.
std::uint64_t nearest_with_low_bits(std::uint32_t low, std::uint64_t reference);

// Remembers which of the numbers 1, 2, 3, ... were seen, in constant space (RFC 6479). What is too
// old to be remembered counts as seen, and so does 0, which stands for "none".
class ReplayWindow {
  public:
    bool is_fresh(std::uint64_t number) const;
    void mark(std::uint64_t number);
    // 0 when nothing was seen.
    std::uint64_t newest() const { return newest_; }
    // Bit i is set when newest() - 1 - i was seen.
    std::uint64_t seen_before_newest() const;

  private:
    std::bitset<kReplayWindowPackets> seen_;
    std::uint64_t newest_ = 0;
};

}  // namespace fts::net
