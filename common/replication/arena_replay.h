// ArenaReplay: an arena run on from a snapshot by the events that the server tells of, tick by
// tick, with the physics that both ends share. What comes out is the server's own snapshot, to the
// last bit; between snapshots it has every tick, and every hit with its moment.
//
// Starts at a snapshot of a server that snaps its state every `snapshot_ticks` ticks. Events say
// anything; what they say of balls that are not there does nothing. Not thread-safe.
#pragma once

#include "common/replication/control_events.h"
#include "common/replication/hit_log.h"
#include "common/replication/lattice_world.h"

namespace fts::replication {

class ArenaReplay {
  public:
    ArenaReplay(const Course& course, const Snapshot& start, Tick snapshot_ticks);

    // On to `tick`. `events` is canonical; what is not in (this tick, `tick`] is passed over.
    // `after_tick` is called after every tick: the contacts of `world` are those of that tick.
    void run_to(Tick tick, const ArenaEvents& events,
                const std::function<void(const ArenaReplay&)>& after_tick = {});

    Tick tick() const { return state_.tick; }
    game::Phase phase() const { return state_.phase; }
    const LatticeWorld& world() const { return world_; }
    // Of this tick, with the hits of the last `run_to`.
    Snapshot snapshot() const;

  private:
    void step(std::span<const ArenaChange> changes, std::span<const ControlEvent> controls);
    void before_step(const ArenaChange& change);
    void after_step(const ArenaChange& change);
    void log_hits();

    Tick snapshot_ticks_, start_tick_;
    double tick_s_;
    Snapshot state_;  // but for balls and hits
    LatticeWorld world_;
    HitLog hits_;
};

Snapshot replay(const Course& course, const Snapshot& baseline, Tick tick, Tick snapshot_ticks,
                const ArenaEvents& events);

}  // namespace fts::replication
