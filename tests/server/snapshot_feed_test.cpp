#include "server/snapshot_feed.h"

#include <gtest/gtest.h>

#include "common/net/connection.h"
#include "common/replication/control_events.h"
#include "common/replication/delta.h"

namespace fts::server {
namespace {

replication::Snapshot snapshot_at(replication::Tick tick, std::uint16_t balls = 40) {
    replication::Snapshot snapshot;
    snapshot.tick = tick;
    for (std::uint16_t i = 1; i <= balls; ++i) {
        replication::BallState ball;
        ball.id = i;
        ball.x = static_cast<std::int32_t>(100 * i + tick);
        ball.vx = 60;
        ball.radius = 128;
        ball.mass = 256;
        snapshot.balls.push_back(ball);
    }
    return snapshot;
}

using Kind = replication::SnapshotPacket::Kind;

replication::Tick baseline_of(const SnapshotFeed::Coded& coded) {
    const auto& part = coded.parts.at(0);
    return coded.kind == Kind::kStates ? replication::peek_part(part)->baseline_tick
                                       : replication::peek_control_part(part)->baseline_tick;
}

EventLog log_from(replication::Tick tick) {
    EventLog log;
    log.begin(tick);
    return log;
}

TEST(SnapshotFeed, encodes_once_for_all_who_hold_the_same_baseline) {
    SnapshotFeed feed;
    feed.publish(snapshot_at(2));
    feed.publish(snapshot_at(4));
    const EventLog log = log_from(2);
    const auto* first = &feed.coded_for(2, log);
    EXPECT_EQ(&feed.coded_for(2, log), first);
    EXPECT_EQ(feed.encoded_count(), 1U);
    EXPECT_EQ(baseline_of(*first), 2U);
    feed.coded_for(0, log);
    EXPECT_EQ(feed.encoded_count(), 2U);
}

TEST(SnapshotFeed, sends_a_keyframe_to_who_holds_nothing_of_use) {
    SnapshotFeed feed;
    for (replication::Tick tick = 2; tick <= 400; tick += 2) feed.publish(snapshot_at(tick));
    const EventLog log = log_from(2);
    EXPECT_EQ(baseline_of(feed.coded_for(0, log)), 0U);
    EXPECT_EQ(baseline_of(feed.coded_for(2, log)), 0U) << "forgotten by now";
    EXPECT_EQ(baseline_of(feed.coded_for(397, log)), 0U) << "never was";
    EXPECT_EQ(baseline_of(feed.coded_for(400, log)), 0U) << "is the newest itself";
    EXPECT_EQ(baseline_of(feed.coded_for(398, log)), 398U);
}

TEST(SnapshotFeed, tells_events_within_a_level_and_states_across_its_beginning) {
    SnapshotFeed feed;
    for (const replication::Tick tick : {2U, 4U, 6U}) feed.publish(snapshot_at(tick));
    const EventLog log = log_from(4);
    EXPECT_EQ(feed.coded_for(2, log).kind, Kind::kStates);
    EXPECT_EQ(baseline_of(feed.coded_for(2, log)), 2U);
    EXPECT_EQ(feed.coded_for(4, log).kind, Kind::kEvents);
    EXPECT_EQ(feed.coded_for(0, log).kind, Kind::kStates);
}

TEST(SnapshotFeed, sends_states_where_events_do_not_fit_a_datagram) {
    SnapshotFeed feed;
    feed.publish(snapshot_at(2, 1000));
    feed.publish(snapshot_at(4, 1000));
    EventLog log = log_from(2);
    for (std::uint16_t ball = 1; ball <= 1000; ++ball) {
        log.add(replication::ControlEvent{
            .tick = 3, .ball = ball, .thrust_x = static_cast<std::int8_t>(ball * 37 % 127)});
    }
    EXPECT_EQ(feed.coded_for(2, log).kind, Kind::kStates);
}

TEST(SnapshotFeed, makes_parts_that_decode_and_fit_a_datagram) {
    SnapshotFeed feed;
    feed.publish(snapshot_at(2, 1000));
    feed.publish(snapshot_at(4, 1000));
    const EventLog log = log_from(4);
    for (const replication::Tick held : {0U, 2U}) {
        replication::SnapshotAssembler assembler;
        std::optional<replication::Snapshot> whole;
        const auto baseline = held ? snapshot_at(held, 1000) : replication::Snapshot{};
        for (const auto& part : feed.coded_for(held, log).parts) {
            EXPECT_LT(part.size(), net::kMaxPayloadBytes);
            whole = assembler.add(baseline, part);
        }
        ASSERT_TRUE(whole);
        EXPECT_EQ(*whole, snapshot_at(4, 1000));
    }
}

}  // namespace
}  // namespace fts::server
