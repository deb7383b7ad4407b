// Attention: which balls to tell one client of when there is not room for all. First its own; of
// the others whoever has waited longest, where a tick weighs more for a ball that is near it or on
// course to hit it soon. Nobody waits for ever.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/replication/snapshot.h"

namespace fts::server {

class Attention {
  public:
    // How much more a tick weighs.
    static constexpr std::uint32_t kOnCourseWeight = 16, kNearWeight = 8;
    static constexpr double kNearM = 8.0;      // from edge to edge
    static constexpr double kOnCourseS = 1.5;  // until they would touch, as they fly now

    // At most `count` of the balls of `now`, ascending by id. `own_player`: 0 for nobody's.
    std::vector<replication::BallState> most_wanted(const replication::Snapshot& now,
                                                    std::uint16_t own_player,
                                                    std::size_t count) const;
    void told(replication::Tick tick, std::span<const replication::BallState> balls);

  private:
    replication::Tick ticks_waited(std::uint16_t id, replication::Tick now) const;

    std::vector<replication::Tick> told_;  // by id; 0: never
};

}  // namespace fts::server
