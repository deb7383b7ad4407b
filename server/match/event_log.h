// What was done to an arena from outside its physics since a level began: what a client that holds
// a snapshot of it needs to replay what came after. Events older than any baseline are forgotten.
#pragma once

#include <deque>

#include "common/replication/control_events.h"

namespace fts::server {

class EventLog {
  public:
    // Snapshots from `tick` on are of one level, and can be baselines of each other.
    void begin(replication::Tick tick);
    // Ticks do not descend.
    void add(const replication::ControlEvent& event) { controls_.push_back(event); }
    void add(const replication::ArenaChange& change) { changes_.push_back(change); }
    void forget_before(replication::Tick tick);

    bool reaches_back_to(replication::Tick baseline_tick) const { return baseline_tick >= begin_; }
    // Of ticks in (after, up_to].
    replication::ArenaEvents between(replication::Tick after, replication::Tick up_to) const;

  private:
    replication::Tick begin_ = 0;
    std::deque<replication::ControlEvent> controls_;
    std::deque<replication::ArenaChange> changes_;
};

}  // namespace fts::server
