// The event solver: predicts collisions, walls and falls once and keeps them across ticks, so that
// its cost grows with collisions and not with the number of ticks. A tick in which nothing happens
// costs the same for any number of bodies. Kicks, and any other change from outside, void what was
// predicted: where something accelerates in every tick the swept solver does the same for less.
//
// Exact as the swept solver is, with its conventions (solver_swept.h): touching bodies are kept
// apart after a hit, positions are mended by the round-off of times, contacts of one instant are
// resolved as a set (simultaneous.h), inelastic collapse is prevented by the TC model, and
// event_budget() bounds the events of a drift.
//
// Times do not depend on how a span is cut into ticks: the same collisions happen, to the last bit,
// in one tick of an hour and in many short ones (with restitution 1; the TC model knows the tick).
// Events of equal times happen in ascending order of the bodies they belong to.
//
// Drift does not bring positions up to date; `synchronise` does. What falls is removed at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/physics/solver.h"

namespace fts::physics {

// Turns, of the calendar or of bodies into windows, that one drift may take for each event of the
// budget: a body in a thin gas goes from cell to cell many times between collisions. Reaching it is
// an overrun.
inline constexpr std::uint64_t kTurnsPerBudgetedEvent = 64;

// Windows suit crowds of so many and more, in scenes that are not periodic.
inline constexpr std::size_t kFewestInWindows = 256;

// How the future is kept: for any bodies in a calendar (coasting.h), for a crowd of a kind within
// windows of time (crowd_coasting.h), which is faster. What happens is the same but for round-off.
enum class Foresight : std::uint8_t {
    kSuitable,  // windows where they suit what is there at the first drift, and after `forget`
    kCalendar,
};

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_event_solver(Foresight foresight = Foresight::kSuitable);

}  // namespace fts::physics
