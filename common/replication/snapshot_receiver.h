// SnapshotReceiver: a client's end of the snapshots of one arena. Takes packets as they come, in
// any order and with gaps, and gives each whole snapshot once, newest only: put together from parts
// of states, or replayed from one that it holds by the events that followed. Where it holds none to
// replay from, it gives a sketch of what it has been told (arena_sketch.h).
//
// Whatever a packet says, what comes out as exact is a canonical snapshot that the sender has.
// Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/replication/arena_sketch.h"
#include "common/replication/delta.h"
#include "common/replication/messages.h"
#include "common/replication/shared_replay.h"
#include "common/replication/snapshot_history.h"

namespace fts::replication {

// The tick that a packet which was decoded is of.
Tick tick_of(const SnapshotPacket& packet);

class SnapshotReceiver {
  public:
    struct Counts {
        std::uint64_t late = 0;       // snapshots of which something came after a newer one
        std::uint64_t malformed = 0;  // parts that made no sense
        // Replayed to another state than the sender's. States are asked for then, by acknowledging
        // nothing.
        std::uint64_t unlike = 0;
    };
    using CourseOf = SharedReplay::CourseOf;

    explicit SnapshotReceiver(
        std::shared_ptr<SharedReplay> replays = std::make_shared<SharedReplay>())
        : replays_(std::move(replays)) {}

    struct Received {
        std::shared_ptr<const Snapshot> snapshot;  // null: nothing new
        // What people did since the exact one before, as far as it was told.
        std::vector<ControlEvent> controls = {};
        bool exact = true;  // the sender's own; else a sketch
    };
    // A whole snapshot, newer than every exact one before, if this packet completes one; or a
    // sketch, whose tick may be that of the last one.
    Received receive(const SnapshotPacket& packet, Tick snapshot_ticks, const CourseOf& course_of);
    Received receive(const KeyframePart& part, Tick snapshot_ticks, const CourseOf& course_of);

    // What to acknowledge: the newest whole snapshot that is held; 0: none.
    Tick held_tick() const;
    Counts counts() const;

  private:
    bool is_news(Tick tick);
    std::shared_ptr<const Snapshot> receive_states(std::span<const std::uint8_t> part);
    std::optional<Snapshot> decode_alone(std::span<const std::uint8_t> part);
    Received sketched_with(const Snapshot& part, Tick snapshot_ticks, const CourseOf& course_of);
    void start_over();
    Received receive_events(std::span<const std::uint8_t> part, Tick snapshot_ticks,
                            const CourseOf& course_of);
    std::shared_ptr<const Snapshot> keep(std::shared_ptr<const Snapshot> snapshot);

    SnapshotAssembler assembler_;
    SnapshotHistory history_;
    ArenaSketch sketch_;
    std::shared_ptr<SharedReplay> replays_;
    Tick newest_tick_ = 0;  // ever
    bool any_ = false;
    Counts counts_;
};

}  // namespace fts::replication
