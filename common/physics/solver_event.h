// The event solver: predicts collisions, walls and falls once and keeps them in a calendar across
// ticks, so that its cost grows with collisions and not with time. A tick in which nothing happens
// costs the same for any number of bodies. Kicks, and any other change from outside, void the
// calendar: where something accelerates in every tick the swept solver does the same for less.
//
// Exact as the swept solver is, with its conventions (solver_swept.h): touching bodies are kept
// apart after a hit, positions are mended by the round-off of times, contacts of one instant are
// resolved as a set (simultaneous.h), inelastic collapse is prevented by the TC model, and
// event_budget() bounds the events of a drift. How the future is kept is in coasting.h.
//
// Times do not depend on how a span is cut into ticks: the same collisions happen, to the last bit,
// in one tick of an hour and in many short ones (with restitution 1; the TC model knows the tick).
// Events of equal times happen in ascending order of the bodies they belong to.
//
// Drift does not bring positions up to date; `synchronise` does. What falls is removed at once.
#pragma once

#include <cstdint>
#include <memory>

#include "common/physics/solver.h"

namespace fts::physics {

// Entries of the calendar that may come up in one drift for each event of the budget: a body in a
// thin gas goes from cell to cell many times between collisions. Reaching it is an overrun.
inline constexpr std::uint64_t kTurnsPerBudgetedEvent = 64;

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_event_solver();

}  // namespace fts::physics
