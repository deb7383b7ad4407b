#include "server/snapshot_feed.h"

#include <cassert>
#include <utility>

#include "common/net/connection.h"
#include "common/replication/delta.h"
#include "common/replication/snapshot_codec.h"

namespace fts::server {

namespace {

// What a SnapshotPacket adds around its part.
constexpr std::size_t kPacketOverheadBytes = 24;
constexpr std::size_t kMaxPartBytes = net::kMaxPayloadBytes - kPacketOverheadBytes;
static_assert(kMaxPartBytes >= replication::kAmplePartBytes);

}  // namespace

void SnapshotFeed::publish(replication::Snapshot snapshot) {
    assert(snapshot.tick > newest_tick());
    newest_ = std::make_shared<const replication::Snapshot>(std::move(snapshot));
    history_.add(newest_);
    encoded_.clear();
}

replication::Tick SnapshotFeed::newest_tick() const {
    return newest_ ? newest_->tick : 0;
}

const SnapshotFeed::Coded& SnapshotFeed::coded_for(replication::Tick held_tick,
                                                   const EventLog& log) {
    assert(newest_);
    const auto baseline = held_tick < newest_->tick ? history_.find(held_tick) : nullptr;
    const replication::Tick baseline_tick = baseline ? held_tick : 0;

    const auto found = encoded_.find(baseline_tick);
    if (found != encoded_.end()) return found->second;
    ++encoded_count_;
    return encoded_[baseline_tick] = encode(baseline.get(), log);
}

SnapshotFeed::Coded SnapshotFeed::encode(const replication::Snapshot* baseline,
                                         const EventLog& log) const {
    using Kind = replication::SnapshotPacket::Kind;
    static const replication::Snapshot kNothing;
    const bool can_be_replayed = baseline && log.reaches_back_to(baseline->tick) &&
                                 newest_->tick - baseline->tick <= replication::kMaxPredictedTicks;
    if (can_be_replayed) {
        const replication::ArenaEvents events = log.between(baseline->tick, newest_->tick);
        auto part = replication::encode_events(*baseline, events, *newest_);
        if (part.size() <= kMaxPartBytes) return {Kind::kEvents, {std::move(part)}};
    }
    return {Kind::kStates,
            replication::encode_delta(baseline ? *baseline : kNothing, *newest_, kMaxPartBytes)};
}

}  // namespace fts::server
