#include "server/snapshot_courier.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "common/net/transport.h"
#include "common/replication/delta.h"
#include "server/limits.h"

namespace fts::server {
namespace {

using Kind = replication::SnapshotPacket::Kind;
using replication::Snapshot;
using replication::Tick;

// A client that is this far behind is told of what matters most to it besides.
constexpr Tick kFarBehindTicks = game::kTickRateHz;
// As long as acknowledgements may be under way, parts lead on from where the last ones led to.
constexpr Tick kPatienceTicks = game::kTickRateHz / 3;
// A ball alone in a part: position, velocity, size, mass, handling.
constexpr std::size_t kTypicalBallBytes = 40;
constexpr std::size_t kMostWantedPartBytes = 1000;

}  // namespace

SnapshotCourier::SnapshotCourier(int bytes_per_s)
    : bytes_per_tick_(double(bytes_per_s) / game::kTickRateHz),
      most_saved_bytes_(std::max(2.0 * net::kMaxDatagramBytes, bytes_per_s * kSavedS)),
      saved_bytes_(most_saved_bytes_) {
    assert(bytes_per_s >= kMinClientBytesPerS && bytes_per_s <= kMaxClientBytesPerS);
}

void SnapshotCourier::acknowledge(Tick acked_tick, Tick newest_tick) {
    if (acked_tick > newest_tick) return;
    if (acked_tick != 0 && acked_tick <= held_tick_) return;
    held_tick_ = acked_tick;
    led_until_ = newest_tick + kPatienceTicks;
    if (keyframe_ && held_tick_ >= keyframe_->tick) keyframe_.reset();
}

SnapshotCourier::Sent SnapshotCourier::deliver(SnapshotFeed& feed, const EventLog& log,
                                               std::uint16_t own_player, Link& link) {
    const Snapshot& now = feed.newest();
    save_up(now.tick);
    Sent sent;
    const SnapshotFeed::Coded* const lead = next_lead(feed, log);
    const bool one_packet_will_do = lead && lead->tick == now.tick;
    const bool far_behind = held_tick_ == 0 || now.tick - held_tick_ > kFarBehindTicks;
    if (far_behind && !one_packet_will_do) {
        send_most_wanted(now, own_player, link, sent);
    }
    if (lead) {
        send_leads(lead, feed, log, link, sent);
    } else {
        send_keyframe(feed, log, link, sent);
    }
    return sent;
}

void SnapshotCourier::save_up(Tick now) {
    const Tick ticks = saved_up_to_ == 0 ? 0 : now - saved_up_to_;
    saved_bytes_ = std::min(most_saved_bytes_, saved_bytes_ + ticks * bytes_per_tick_);
    saved_up_to_ = now;
}

bool SnapshotCourier::spend(std::size_t part_bytes) {
    const auto bytes = static_cast<double>(part_bytes + kBytesAroundPart);
    if (saved_bytes_ < bytes) return false;
    saved_bytes_ -= bytes;
    return true;
}

// From what it says it holds, if the budget lets all of that be told again, as losing a packet then
// costs nothing; else from where it was led to.
const SnapshotFeed::Coded* SnapshotCourier::next_lead(SnapshotFeed& feed, const EventLog& log) {
    const Tick now = feed.newest_tick();
    const SnapshotFeed::Coded* const lead = feed.lead_on(held_tick_, log);
    if (!lead || !is_under_way(now) || can_afford_all(lead, feed, log)) return lead;
    return feed.lead_on(led_to_tick_, log);
}

bool SnapshotCourier::can_afford_all(const SnapshotFeed::Coded* lead, SnapshotFeed& feed,
                                     const EventLog& log) const {
    double bytes = 0.0;
    while (lead && bytes <= saved_bytes_) {
        bytes += static_cast<double>(lead->part.size() + kBytesAroundPart);
        if (lead->tick == feed.newest_tick()) return bytes <= saved_bytes_;
        lead = feed.lead_on(lead->tick, log);
    }
    return false;
}

void SnapshotCourier::send_leads(const SnapshotFeed::Coded* lead, SnapshotFeed& feed,
                                 const EventLog& log, Link& link, Sent& sent) {
    const Tick now = feed.newest_tick();
    if (!is_under_way(now)) led_until_ = now + kPatienceTicks;
    while (lead) {
        if (!spend(lead->part.size())) {
            sent.over_budget = true;
            return;
        }
        link.send(lead->kind, lead->part);
        led_to_tick_ = lead->tick;
        if (lead->tick == now) return;
        lead = feed.lead_on(lead->tick, log);
    }
}

// With half of the budget at most, so that the rest gets on, too.
void SnapshotCourier::send_most_wanted(const Snapshot& now, std::uint16_t own_player, Link& link,
                                       Sent& sent) {
    static const Snapshot kNothing;
    const double affordable = 0.5 * saved_bytes_ - kBytesAroundPart;
    if (affordable < replication::kMinPartBytes) {
        sent.over_budget = true;
        return;
    }
    const std::size_t part_bytes =
        std::min(kMostWantedPartBytes, static_cast<std::size_t>(affordable));
    Snapshot some;
    some.tick = now.tick;
    some.arena = now.arena;
    some.phase = now.phase;
    some.level = now.level;
    some.phase_end_tick = now.phase_end_tick;
    std::size_t count = std::max(std::size_t{1}, part_bytes / kTypicalBallBytes);
    for (; count > 0; count = count * 2 / 3) {
        some.balls = attention_.most_wanted(now, own_player, count);
        const auto parts = replication::encode_delta(kNothing, some, part_bytes);
        if (parts.size() != 1) continue;
        spend(parts.front().size());
        link.send(Kind::kSomeStates, parts.front());
        attention_.told(now.tick, some.balls);
        return;
    }
}

void SnapshotCourier::send_keyframe(SnapshotFeed& feed, const EventLog& log, Link& link,
                                    Sent& sent) {
    if (keyframe_ && !log.reaches_back_to(keyframe_->tick)) {
        keyframe_.reset();
        sent.keyframe_given_up = true;
    }
    if (!keyframe_) {
        keyframe_ = feed.keyframe();
        next_keyframe_part_ = 0;
        sent.keyframe_begun = true;
    }
    while (next_keyframe_part_ < keyframe_->messages.size()) {
        const std::vector<std::uint8_t>& message = keyframe_->messages[next_keyframe_part_];
        if (!spend(message.size())) {
            sent.over_budget = true;
            return;
        }
        if (!link.send_reliable(message)) return;
        ++next_keyframe_part_;
    }
}

}  // namespace fts::server
