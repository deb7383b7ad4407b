// Random canonical snapshots from a seed: wild ones that use every range to its ends, and scenes
// that move as balls on a platform do.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "common/replication/snapshot.h"

namespace fts::replication::testing {

using Rng = std::mt19937_64;

// Whole numbers of [low, high]; the standard distributions differ between libraries.
inline std::int64_t pick(Rng& rng, std::int64_t low, std::int64_t high) {
    const std::uint64_t span = static_cast<std::uint64_t>(high - low) + 1;
    return low + static_cast<std::int64_t>(rng() % span);
}
inline bool chance(Rng& rng, int percent) {
    return pick(rng, 0, 99) < percent;
}

// Any value of its ranges, small ones and the very ends more often than not.
Snapshot wild_snapshot(Rng& rng, Tick tick, std::size_t max_balls);
// What `before` might be some ticks later: entries gone, new, moved, changed in any field.
Snapshot wild_successor(Rng& rng, const Snapshot& before, Tick tick);

struct SnapshotPair {
    Snapshot before, now;
};
// `before` can be named as the baseline of `now` (delta.h).
SnapshotPair wild_pair(Rng& rng, std::size_t max_balls);

// Balls on a disc of 12 m that thrust, coast and bounce off its edge and, now and then, off each
// other.
class MovingScene {
  public:
    enum class Drive : std::uint8_t { kCoasting, kSteered };

    MovingScene(std::uint64_t seed, std::size_t ball_count, Drive drive);
    void tick();
    Snapshot snapshot(Tick tick) const;

  private:
    struct Ball {
        double x_m, y_m, vx_mps, vy_mps;
        std::int8_t thrust_x, thrust_y;
        double radius_m, mass_kg;
    };
    void steer(Ball& ball);
    void collide();

    Rng rng_;
    Drive drive_;
    std::vector<Ball> balls_;
};

}  // namespace fts::replication::testing
