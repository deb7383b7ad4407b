// Puts the overlaps that a search found, in any order, into that in which they are resolved.
#pragma once

#include <cstdint>
#include <vector>

#include "common/physics/body.h"

namespace fts::physics {

// Two bodies and where they are in a working copy; that of the lower slot first.
struct BodyPair {
    BodyId a, b;
    std::uint32_t place_a = 0, place_b = 0;
};

class HitOrder {
  public:
    // By the slot of a, then that of b, each pair once. Slots are below `slots`.
    void sort(std::vector<BodyPair>& hits, std::uint32_t slots);

  private:
    void scatter(const std::vector<BodyPair>& from, std::vector<BodyPair>& to, unsigned shift);

    unsigned digit_bits_ = 0;
    std::vector<std::uint32_t> begins_;
    std::vector<BodyPair> half_sorted_;
};

}  // namespace fts::physics
