// An exact tick that can be compared with a solver's: one whose collisions are in it, or not,
// beyond doubt.
//
// A velocity jumps at a collision. Where one happens within round-off of a tick's end, solver and
// oracle may rightly have it in different ticks, and comparing velocities would say that all is
// wrong.
#pragma once

#include <optional>

#include "common/physics/scene.h"
#include "server/lab/exact_tick.h"

namespace fts::lab {

enum class Verdict { kDecided, kUndecided, kTooBusy };

struct DecidedTick {
    Verdict verdict = Verdict::kDecided;
    std::optional<ExactTick> exact;  // when decided
};

// `epsilon` is of the solver's numbers; times are uncertain by what it does to the coordinates.
DecidedTick decided_tick(const physics::Scene& scene, double span_s, double epsilon,
                         double max_work);

}  // namespace fts::lab
