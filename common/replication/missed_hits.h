// Hits that a run of the physics has missed: two balls that passed each other by less than
// accelerations explain which nobody told of, while the next snapshot has one gain about the
// momentum that the other lost, in the direction and of the size of a hit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/replication/flight_fit.h"
#include "common/replication/flight_run.h"

namespace fts::replication {

struct MissedHit {
    std::uint32_t a = 0, b = 0;
    double from_s = 0.0, time_s = 0.0;               // of the flight before it
    physics::Vec2d miss_m = physics::Vec2d::Zero();  // what a lacks to touch b at `time_s`
};

// Of the balls with a gap in velocity that is not zero. No ball is in two of them.
std::vector<MissedHit> find_missed_hits(const FlightRun& run, double restitution, double span_s,
                                        std::span<const Gap> gaps);

// Adds to `pushes` what makes the two touch: half of it for each.
void add_pushes_to_touch(const MissedHit& hit, double tick_s, Tick ticks, Pushes& pushes);

}  // namespace fts::replication
