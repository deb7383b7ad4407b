#include "server/snapshot_feed.h"

#include <cassert>
#include <utility>

#include "common/net/connection.h"
#include "common/replication/delta.h"
#include "common/replication/snapshot_codec.h"
#include "common/replication/wire.h"

namespace fts::server {

namespace {

using Kind = replication::SnapshotPacket::Kind;
using replication::Snapshot;
using replication::Tick;

const Snapshot kNothing;

constexpr std::size_t kMaxPartBytes =
    net::kMaxPayloadBytes - replication::kMaxSnapshotPacketOverheadBytes;
static_assert(kMaxPartBytes >= replication::kAmplePartBytes);
static_assert(replication::kMaxKeyframePartBytes >= replication::kAmplePartBytes);
static_assert(replication::kMaxPredictedTicks <= replication::kMaxBaselineAgeTicks);

// With more of them a snapshot that has no baseline does not fit a datagram; nor is it tried.
constexpr std::size_t kMostBallsInADatagram = kMaxPartBytes / 8;
// Who needs a keyframe within this time of another's is sent the same one.
constexpr Tick kKeyframeSharedForTicks = 15;

}  // namespace

void SnapshotFeed::publish(Snapshot snapshot) {
    assert(snapshot.tick > newest_tick());
    newest_ = std::make_shared<const Snapshot>(std::move(snapshot));
    history_.add(newest_);
    encoded_.clear();
}

Tick SnapshotFeed::newest_tick() const {
    return newest_ ? newest_->tick : 0;
}

const SnapshotFeed::Coded* SnapshotFeed::lead_on(Tick held_tick, const EventLog& log) {
    assert(newest_);
    const auto baseline = held_tick < newest_->tick ? history_.find(held_tick) : nullptr;
    const Tick baseline_tick = baseline ? held_tick : 0;
    auto found = encoded_.find(baseline_tick);
    if (found == encoded_.end()) {
        ++encoded_count_;
        found = encoded_.emplace(baseline_tick, encode(baseline.get(), log)).first;
    }
    return found->second ? &*found->second : nullptr;
}

std::optional<SnapshotFeed::Coded> SnapshotFeed::encode(const Snapshot* baseline,
                                                        const EventLog& log) const {
    if (baseline && log.reaches_back_to(baseline->tick)) return encode_events(*baseline, log);
    return encode_states(baseline);
}

std::optional<SnapshotFeed::Coded> SnapshotFeed::encode_events(const Snapshot& baseline,
                                                               const EventLog& log) const {
    auto outcome = newest_;
    while (outcome && outcome->tick > baseline.tick) {
        auto part = replication::encode_events(baseline, log.between(baseline.tick, outcome->tick),
                                               *outcome);
        if (part.size() <= kMaxPartBytes) {
            const Kind kind = outcome == newest_ ? Kind::kEvents : Kind::kEarlierEvents;
            return Coded{kind, outcome->tick, std::move(part)};
        }
        outcome = history_.newest_up_to(baseline.tick + (outcome->tick - baseline.tick) / 2);
    }
    return std::nullopt;
}

std::optional<SnapshotFeed::Coded> SnapshotFeed::encode_states(const Snapshot* baseline) const {
    if (newest_->balls.size() > kMostBallsInADatagram) return std::nullopt;
    auto parts =
        replication::encode_delta(baseline ? *baseline : kNothing, *newest_, kMaxPartBytes);
    if (parts.size() != 1) return std::nullopt;
    return Coded{Kind::kStates, newest_->tick, std::move(parts.front())};
}

std::shared_ptr<const SnapshotFeed::Keyframe> SnapshotFeed::keyframe() {
    assert(newest_);
    if (keyframe_ && newest_->tick - keyframe_->tick <= kKeyframeSharedForTicks) return keyframe_;
    auto keyframe = std::make_shared<Keyframe>();
    keyframe->tick = newest_->tick;
    for (std::vector<std::uint8_t>& part :
         replication::encode_delta(kNothing, *newest_, replication::kMaxKeyframePartBytes)) {
        keyframe->messages.push_back(replication::encode(
            replication::ServerMessage(replication::KeyframePart{std::move(part)})));
    }
    keyframe_ = std::move(keyframe);
    return keyframe_;
}

}  // namespace fts::server
