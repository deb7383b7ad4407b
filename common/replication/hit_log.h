// The collisions since the last snapshot that are worth a spark. Bounded: when there are more than
// kMaxHits, the strongest stay and the rest are counted.
#pragma once

#include <cstdint>
#include <vector>

#include "common/physics/record.h"
#include "common/replication/snapshot.h"

namespace fts::replication {

// The hit that a contact of two balls was, in tick `tick`.
HitState hit_of(const physics::Contact<double>& contact, Tick tick, std::uint16_t a,
                std::uint16_t b);

class HitLog {
  public:
    static constexpr std::size_t kMaxHits = 64;

    // A pair that collides twice in one tick is one hit, its stronger one.
    void add(const HitState& hit);
    // Sorted by (tick, a, b).
    std::vector<HitState> sorted() const;
    void clear() { hits_.clear(); }
    std::uint64_t left_out() const { return left_out_; }

  private:
    std::vector<HitState> hits_;
    std::uint64_t left_out_ = 0;
};

}  // namespace fts::replication
