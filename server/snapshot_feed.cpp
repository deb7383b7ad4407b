#include "server/snapshot_feed.h"

#include <cassert>
#include <utility>

#include "common/net/connection.h"
#include "common/replication/delta.h"

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

const SnapshotFeed::Parts& SnapshotFeed::parts_for(replication::Tick held_tick) {
    assert(newest_);
    auto baseline = held_tick < newest_->tick ? history_.find(held_tick) : nullptr;
    const replication::Tick baseline_tick = baseline ? held_tick : 0;

    const auto found = encoded_.find(baseline_tick);
    if (found != encoded_.end()) return found->second;

    static const replication::Snapshot kNothing;
    ++encoded_count_;
    return encoded_[baseline_tick] =
               replication::encode_delta(baseline ? *baseline : kNothing, *newest_, kMaxPartBytes);
}

}  // namespace fts::server
