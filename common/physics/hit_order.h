// Puts the overlaps that a search found, in any order, into that in which they are resolved.
#pragma once

#include <cstdint>
#include <vector>

namespace fts::physics {

// Two bodies, by slot and by where they are in a working copy; the lower slot first.
struct SlotPair {
    std::uint32_t slot_a, slot_b;
    std::uint32_t place_a, place_b;
};

class HitOrder {
  public:
    // By slot_a, then slot_b, each pair once. Slots are below `slots`.
    void sort(std::vector<SlotPair>& pairs, std::uint32_t slots);

  private:
    void scatter(const std::vector<SlotPair>& from, std::vector<SlotPair>& to, unsigned shift);

    unsigned digit_bits_ = 0;
    std::vector<std::uint32_t> begins_;
    std::vector<SlotPair> half_sorted_;
};

}  // namespace fts::physics
