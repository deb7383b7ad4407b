// The snapshots of one arena on their way to its clients. Who holds a recent one is told what has
// happened since (control_events.h) and simulates the rest; who does not is sent states (delta.h).
// Each is encoded once, however many clients hold the same baseline.
//
// Every part fits a datagram. Where more has happened than fits, a part leads to an earlier
// snapshot than the newest, from which the next one leads on.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
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
        replication::Tick tick = 0;  // of the snapshot that it leads to
        std::vector<std::uint8_t> part;
    };
    // One snapshot without a baseline, as messages of the reliable channel (KeyframePart).
    struct Keyframe {
        replication::Tick tick = 0;
        std::vector<std::vector<std::uint8_t>> messages;
    };

    // Makes `snapshot` the newest one. Ticks ascend.
    void publish(replication::Snapshot snapshot);
    // 0: nothing published yet.
    replication::Tick newest_tick() const;
    // Expects a published snapshot, as does what follows.
    const replication::Snapshot& newest() const { return *newest_; }

    // What leads on from the snapshot of `held_tick` (0: none): events, or states if the log does
    // not reach back to it. `log` is of the arena. Null when nothing that fits a datagram does: a
    // keyframe is needed. Valid until the next snapshot.
    const Coded* lead_on(replication::Tick held_tick, const EventLog& log);
    // Of the newest snapshot or one that is hardly older.
    std::shared_ptr<const Keyframe> keyframe();

    std::uint64_t encoded_count() const { return encoded_count_; }

  private:
    std::optional<Coded> encode(const replication::Snapshot* baseline, const EventLog& log) const;
    std::optional<Coded> encode_events(const replication::Snapshot& baseline,
                                       const EventLog& log) const;
    std::optional<Coded> encode_states(const replication::Snapshot* baseline) const;

    replication::SnapshotHistory history_;
    std::shared_ptr<const replication::Snapshot> newest_;
    // Of the newest, by the tick of its baseline.
    std::map<replication::Tick, std::optional<Coded>> encoded_;
    std::shared_ptr<const Keyframe> keyframe_;
    std::uint64_t encoded_count_ = 0;
};

}  // namespace fts::server
