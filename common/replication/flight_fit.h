// What accelerated balls that nobody told of: the least accelerations that make a run of the
// physics end where the next snapshot says.
//
// A ball in free flight is pushed along a cubic, which is the curve of least squared acceleration
// between two places and velocities. Where balls hit, what a push before the hit does to both
// afterwards is followed to first order (the shift of the moment, the turn of the normal), and the
// accelerations of all balls that hit each other are found together: least squares by conjugate
// gradients, in which every step is one walk along the hits back and one forth.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/replication/flight_run.h"

namespace fts::replication {

// Of place and velocity: what a run leaves open at its end, or a small change of a ball.
struct Gap {
    physics::Vec2d m = physics::Vec2d::Zero();
    physics::Vec2d mps = physics::Vec2d::Zero();
};

// The time integral of the least squared acceleration that closes a gap of a free flight in
// `span_s`, m^2/s^3.
double effort_of(const Gap& gap, double span_s);

// Adds to `pushes` what closes `gaps`. Where `bound` is false the end of a ball is not known, and
// its gap is not looked at.
void add_least_pushes(const FlightRun& run, double restitution, double tick_s, Tick ticks,
                      std::span<const Gap> gaps, const std::vector<std::uint8_t>& bound,
                      Pushes& pushes);

}  // namespace fts::replication
