// From a baseline to what is to be expected some ticks later: straight lines, or the shared physics
// run forward. Pure, and the same to the last bit at both ends.
//
// Each expectation says how sure it is. A baseline is rounded to its lattice, and collisions
// magnify what rounding left open (a normal that is off by an angle turns the exchanged velocity by
// twice that); this is followed along every collision to first order, so that the codec knows of
// each ball how wide to look, and in which direction.
#pragma once

#include <cstdint>
#include <span>

#include "common/replication/lattice_world.h"
#include "common/replication/prediction.h"

namespace fts::replication {

enum class Foresight : std::uint8_t {
    kStraightLines,     // nothing but velocities
    kCollisions,        // walls, balls and drag; nobody steers
    kControls,          // and the baseline's controls go on acting
    kControlsOnLattice  // and the server snaps its state at every snapshot
};

struct Steering {
    // What may accelerate a ball that somebody steers (BallKind::kPlayer) unforeseen, m/s^2.
    double unforeseen_mps2 = 0.0;
    // Ticks between snapshots, a whole number of which lie between the baseline and the tick where
    // the server snaps.
    Tick snapshot_ticks = 3;
};

// `baseline` ascends by id. `tick` is after `baseline_tick`.
Prediction predict(const Course& course, const Steering& steering, Foresight foresight,
                   std::span<const BallState> baseline, Tick baseline_tick, Tick tick);

}  // namespace fts::replication
