// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014): a
// seed gives the same numbers on every machine. For making scenes and matches; no solver draws from
// it, and it keeps no secret.
#pragma once

#include <cassert>
#include <cstdint>

namespace fts::physics {

class SplitMix {
  public:
    explicit SplitMix(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next() {
        state_ += 0x9e3779b97f4a7c15U;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31);
    }
    // [0, 1), every value a multiple of 2^-53.
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * uniform(); }
    // [0, count); the bias of the remainder is below count / 2^64.
    std::uint64_t below(std::uint64_t count) {
        assert(count > 0);
        return next() % count;
    }

  private:
    std::uint64_t state_;
};

}  // namespace fts::physics
