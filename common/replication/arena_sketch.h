// ArenaSketch: an arena as far as parts have told of it, for a client that has no whole snapshot of
// now: one that joins, was away, or is sent less than what happens. Each part shows at once; what
// no part has told of lately moves on as the shared physics and its last controls have it.
//
// A guess, and never a baseline: balls of one sketch were told of at different ticks. One of which
// nothing has been told for kForgottenAfterTicks is left out. Hits are not guessed.
#pragma once

#include <map>

#include "common/replication/lattice_world.h"
#include "common/replication/snapshot.h"

namespace fts::replication {

class ArenaSketch {
  public:
    static constexpr Tick kForgottenAfterTicks = 600;  // as long as no id is used again

    const Snapshot& now() const { return now_; }

    // All that is known is this snapshot.
    void begin(const Snapshot& whole);
    // Some of the balls and coins of one tick. What is newer than the sketch takes it along; of
    // what is older only balls that it does not have are taken, as far on as they fly straight.
    void tell(const Snapshot& part, const Course& course, Tick snapshot_ticks);

  private:
    void move_on(const Snapshot& part, const Course& course, Tick snapshot_ticks);
    void forget_old_ones();

    Snapshot now_;
    std::map<std::uint16_t, Tick> told_;  // of each ball, last
};

}  // namespace fts::replication
