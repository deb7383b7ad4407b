// The newest snapshots by tick, a fixed number of them: what a server keeps to encode deltas
// against and a client keeps to decode them. A tick that has made room for a newer one is simply
// absent.
#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "common/replication/snapshot.h"

namespace fts::replication {

class SnapshotHistory {
  public:
    static constexpr std::size_t kCapacity = 64;  // about two seconds at 30 Hz

    // Not null. Replaces one of the same tick; when full, the oldest makes room, and a snapshot
    // older than all that are held is not kept.
    void add(std::shared_ptr<const Snapshot> snapshot);
    // nullptr when the tick is not held.
    std::shared_ptr<const Snapshot> find(Tick tick) const;
    // Of the greatest tick; nullptr when empty.
    std::shared_ptr<const Snapshot> newest() const;
    void clear();

  private:
    std::array<std::shared_ptr<const Snapshot>, kCapacity> slots_;
};

}  // namespace fts::replication
