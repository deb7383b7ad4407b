// A fixed ring of the newest snapshots by tick: what a server keeps to encode deltas against and a client
// keeps to decode them. A tick that has been overwritten is simply absent.
#pragma once

#include <array>
#include <memory>

#include "common/replication/snapshot.h"

namespace fts::replication {

class SnapshotHistory {
  public:
    static constexpr std::size_t kCapacity = 64;  // about two seconds at 30 Hz

    void add(std::shared_ptr<const Snapshot> snapshot);
    // nullptr when the tick is not held.
    std::shared_ptr<const Snapshot> find(Tick tick) const;
    std::shared_ptr<const Snapshot> newest() const;
    void clear();

  private:
    std::array<std::shared_ptr<const Snapshot>, kCapacity> ring_;
    std::size_t next_ = 0;
};

}  // namespace fts::replication
