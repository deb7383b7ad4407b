// SnapshotCourier: what one client is sent of its arena, and when, within a budget of bytes.
//
// A client that holds a snapshot is led on from it, by several packets in a row if much has
// happened. One that holds none of use, since it has joined or was away for seconds, is sent a
// keyframe over the reliable channel, a few parts at a time, and meanwhile, in each packet, the
// balls of now that matter most to it (attention.h). So is one that has fallen far behind.
//
// Time is in ticks. A budget that is not used up is kept for kSavedS, no longer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "common/replication/messages.h"
#include "common/replication/snapshot.h"
#include "server/attention.h"
#include "server/match/event_log.h"
#include "server/snapshot_feed.h"

namespace fts::server {

class SnapshotCourier {
  public:
    static constexpr double kSavedS = 0.1;
    // What a datagram adds to a part: our packet, the seal, UDP and IP.
    static constexpr std::size_t kBytesAroundPart = 80;

    class Link {
      public:
        virtual ~Link() = default;
        virtual void send(replication::SnapshotPacket::Kind kind,
                          std::span<const std::uint8_t> part) = 0;
        // False: not now.
        virtual bool send_reliable(std::span<const std::uint8_t> message) = 0;
    };

    // `bytes_per_s` in [kMinClientBytesPerS, kMaxClientBytesPerS] (limits.h).
    explicit SnapshotCourier(int bytes_per_s);

    // The client says that the newest snapshot it holds is of `acked_tick`; 0: that it holds none.
    void acknowledge(replication::Tick acked_tick, replication::Tick newest_tick);

    struct Sent {
        bool over_budget = false;  // something would have been sent if there were more of it
        bool keyframe_begun = false;
        bool keyframe_given_up = false;  // it had become too old to be led on from
    };
    // Once for each snapshot that is published. `log` is of the arena.
    Sent deliver(SnapshotFeed& feed, const EventLog& log, std::uint16_t own_player, Link& link);

  private:
    void save_up(replication::Tick now);
    bool spend(std::size_t part_bytes);
    const SnapshotFeed::Coded* next_lead(SnapshotFeed& feed, const EventLog& log);
    bool can_afford_all(const SnapshotFeed::Coded* lead, SnapshotFeed& feed,
                        const EventLog& log) const;
    void send_leads(const SnapshotFeed::Coded* lead, SnapshotFeed& feed, const EventLog& log,
                    Link& link, Sent& sent);
    void send_most_wanted(const replication::Snapshot& now, std::uint16_t own_player, Link& link,
                          Sent& sent);
    void send_keyframe(SnapshotFeed& feed, const EventLog& log, Link& link, Sent& sent);
    bool is_under_way(replication::Tick now) const {
        return led_to_tick_ > held_tick_ && now <= led_until_;
    }

    double bytes_per_tick_, most_saved_bytes_, saved_bytes_;
    replication::Tick saved_up_to_ = 0;
    replication::Tick held_tick_ = 0;
    // How far it was led on, and the tick by which it should have said so.
    replication::Tick led_to_tick_ = 0, led_until_ = 0;
    std::shared_ptr<const SnapshotFeed::Keyframe> keyframe_;  // that it is sent
    std::size_t next_keyframe_part_ = 0;
    Attention attention_;
};

}  // namespace fts::server
