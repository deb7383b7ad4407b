// The newest snapshots by tick: what a server keeps to encode against and a client keeps to decode
// with. One that is more than kMaxBaselineAgeTicks older than the newest can be nobody's baseline
// any more (delta.h) and is simply absent.
#pragma once

#include <deque>
#include <memory>

#include "common/replication/snapshot.h"

namespace fts::replication {

class SnapshotHistory {
  public:
    // Not null. Replaces one of the same tick; one that is too old already is not kept.
    void add(std::shared_ptr<const Snapshot> snapshot);
    // nullptr when the tick is not held.
    std::shared_ptr<const Snapshot> find(Tick tick) const;
    // Of the greatest tick; nullptr when empty.
    std::shared_ptr<const Snapshot> newest() const;
    // The newest at or before `tick`; nullptr when there is none.
    std::shared_ptr<const Snapshot> newest_up_to(Tick tick) const;
    void clear() { held_.clear(); }

  private:
    std::deque<std::shared_ptr<const Snapshot>> held_;  // ascending by tick
};

}  // namespace fts::replication
