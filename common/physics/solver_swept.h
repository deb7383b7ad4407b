// The swept solver: finds the exact times of impact inside the span and processes them in time
// order (at equal times: collisions, walls, falls, and lower indices first), so that nothing
// tunnels at any speed.
//
// Each body is moved only when something happens to it. After a collision only its two partners are
// predicted anew; what was predicted for them before is recognised as stale by their event counts.
//
// Two bodies that have just hit each other move apart and cannot meet again before something else
// happens to one of them; such a pair is not predicted, so that round-off never makes a pair
// collide twice at one instant. After moving to the time of impact, which is only as fine as the
// clock, a pair is moved on along its own velocities by at most kClockSlack of round-off until it
// just touches; no velocity changes, so that energy and momentum do not.
//
// With restitution below 1 balls could collide infinitely often in a finite time (inelastic
// collapse). A body that was hit less than kElasticWithin of the span ago therefore loses nothing:
// the TC model of Luding and McNamara, "How to handle the inelastic collapse of a dissipative
// hard-sphere gas" (1998).
//
// When anything else touches the two of a collision, or is due at the same instant and touches
// them, all such contacts are resolved as a set (simultaneous.h); a pair alone keeps its closed
// form, and its bits.
//
// Who may meet whom is found for one look at a time, a part of the span in which most bodies move
// by less than a radius (swept_paths.h): collisions between fast bodies are many, and in a short
// time few others are near. What is predicted for a pair depends on the last event of either alone,
// and not on the look it is predicted in.
//
// In a periodic scene a pair is predicted once for each image of the one that may meet the other.
// The span is cut into stretches in which nobody moves by more than a quarter of the box, so that
// few images come into question, and positions are brought back into the box after each; a
// collision that makes somebody faster cuts the stretch it happens in. A span that needs more than
// kMaxStretches is not simulated to its end, and that is reported as an overrun.
//
// The number of events of one drift is bounded by event_budget(). When more are due the drift stops
// at the time of the last one processed, at which nothing overlaps, and says so. Only what truly
// never ends does that: a ball that exactly fills the room between two infinite masses, or is
// squeezed by them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/physics/solver.h"

namespace fts::physics {

inline constexpr std::uint32_t kBaseEventBudget = 4096;
inline constexpr std::uint32_t kEventBudgetPerBody = 64;

// Hits in a set are cheaper than collisions alone: so many count as one against the budget.
inline constexpr std::uint32_t kSetHitsPerEvent = 8;
inline constexpr std::uint32_t kMaxStretches = 1U << 18;

// By how many units of the round-off of a time of impact a clock may be wrong.
inline constexpr double kClockSlack = 8.0;
// A part of the span.
inline constexpr double kElasticWithin = 1e-3;

std::uint32_t event_budget(std::size_t bodies);

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_swept_solver();

}  // namespace fts::physics
