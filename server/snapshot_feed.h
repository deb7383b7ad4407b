// The snapshots of one arena on their way to its clients. Who holds a recent one is told what has
// happened since (control_events.h) and simulates the rest; everybody else is sent states
// (delta.h). Each is encoded once, however many clients hold the same baseline.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "common/replication/messages.h"
#include "common/replication/snapshot.h"
#include "common/replication/snapshot_history.h"
#include "server/match/event_log.h"

namespace fts::server {

class SnapshotFeed {
  public:
    struct Coded {
        replication::SnapshotPacket::Kind kind = replication::SnapshotPacket::Kind::kStates;
        std::vector<std::vector<std::uint8_t>> parts;
    };

    // Makes `snapshot` the newest one. Ticks ascend.
    void publish(replication::Snapshot snapshot);
    // 0: nothing published yet.
    replication::Tick newest_tick() const;

    // The newest snapshot for a client that holds the one of `held_tick` (0: none): events if that
    // one is still in the history and they fit a datagram, else states, and a keyframe if need be.
    // `log` is of the arena. Expects a published snapshot. Valid until the next one.
    const Coded& coded_for(replication::Tick held_tick, const EventLog& log);

    std::uint64_t encoded_count() const { return encoded_count_; }

  private:
    Coded encode(const replication::Snapshot* baseline, const EventLog& log) const;

    replication::SnapshotHistory history_;
    std::shared_ptr<const replication::Snapshot> newest_;
    std::map<replication::Tick, Coded> encoded_;  // of the newest, by the tick of its baseline
    std::uint64_t encoded_count_ = 0;
};

}  // namespace fts::server
