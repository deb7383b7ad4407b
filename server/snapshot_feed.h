// The snapshots of one arena on their way to its clients: each is built once, and its delta against
// a baseline is encoded once, however many clients hold that baseline.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "common/replication/snapshot.h"
#include "common/replication/snapshot_history.h"

namespace fts::server {

class SnapshotFeed {
  public:
    using Parts = std::vector<std::vector<std::uint8_t>>;

    // Makes `snapshot` the newest one. Ticks ascend.
    void publish(replication::Snapshot snapshot);
    // 0: nothing published yet.
    replication::Tick newest_tick() const;

    // The newest snapshot for a client that holds the one of `held_tick` (0: none): a delta if that
    // one is still in the history, else a keyframe. Expects a published snapshot. Valid until the
    // next one.
    const Parts& parts_for(replication::Tick held_tick);

    std::uint64_t encoded_count() const { return encoded_count_; }

  private:
    replication::SnapshotHistory history_;
    std::shared_ptr<const replication::Snapshot> newest_;
    std::map<replication::Tick, Parts> encoded_;  // of the newest, by the tick of its baseline
    std::uint64_t encoded_count_ = 0;
};

}  // namespace fts::server
