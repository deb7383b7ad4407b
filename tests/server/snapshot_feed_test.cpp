#include "server/snapshot_feed.h"

#include <gtest/gtest.h>

#include "common/net/connection.h"
#include "common/replication/control_events.h"
#include "common/replication/delta.h"
#include "common/replication/wire.h"

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

// 0 where a keyframe is needed or states have no baseline.
replication::Tick baseline_of(const SnapshotFeed::Coded* coded) {
    if (!coded) return 0;
    return coded->kind == Kind::kStates
               ? replication::peek_part(coded->part)->baseline_tick
               : replication::peek_control_part(coded->part)->baseline_tick;
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
    const auto* first = feed.lead_on(2, log);
    EXPECT_EQ(feed.lead_on(2, log), first);
    EXPECT_EQ(feed.encoded_count(), 1U);
    EXPECT_EQ(baseline_of(first), 2U);
    feed.lead_on(0, log);
    EXPECT_EQ(feed.encoded_count(), 2U);
}

TEST(SnapshotFeed, sends_states_without_a_baseline_to_who_holds_nothing_of_use) {
    SnapshotFeed feed;
    for (replication::Tick tick = 2; tick <= 400; tick += 2) feed.publish(snapshot_at(tick));
    const EventLog log = log_from(2);
    for (const replication::Tick held : {0U, 2U, 397U, 400U}) {
        const auto* coded = feed.lead_on(held, log);
        ASSERT_TRUE(coded);
        EXPECT_EQ(coded->kind, Kind::kStates) << held;
        EXPECT_EQ(baseline_of(coded), 0U) << held << ": none, forgotten, never was, the newest";
    }
    EXPECT_EQ(baseline_of(feed.lead_on(398, log)), 398U);
}

TEST(SnapshotFeed, tells_events_within_a_level_and_states_across_its_beginning) {
    SnapshotFeed feed;
    for (const replication::Tick tick : {2U, 4U, 6U}) feed.publish(snapshot_at(tick));
    const EventLog log = log_from(4);
    EXPECT_EQ(feed.lead_on(2, log)->kind, Kind::kStates);
    EXPECT_EQ(baseline_of(feed.lead_on(2, log)), 2U);
    EXPECT_EQ(feed.lead_on(4, log)->kind, Kind::kEvents);
    EXPECT_EQ(feed.lead_on(0, log)->kind, Kind::kStates);
}

TEST(SnapshotFeed, leads_on_in_steps_where_events_do_not_fit_a_datagram) {
    SnapshotFeed feed;
    feed.publish(snapshot_at(2, 1000));
    EventLog log = log_from(2);
    for (replication::Tick tick = 4; tick <= 40; tick += 2) {
        feed.publish(snapshot_at(tick, 1000));
        for (std::uint16_t ball = 1; ball <= 100; ++ball) {
            log.add(replication::ControlEvent{
                .tick = tick, .ball = ball, .thrust_x = static_cast<std::int8_t>(ball + tick)});
        }
    }
    replication::Tick held = 2;
    int steps = 0;
    while (held != 40) {
        const auto* coded = feed.lead_on(held, log);
        ASSERT_TRUE(coded);
        EXPECT_EQ(baseline_of(coded), held);
        EXPECT_EQ(coded->kind, coded->tick == 40 ? Kind::kEvents : Kind::kEarlierEvents);
        EXPECT_LT(coded->part.size(), net::kMaxPayloadBytes);
        ASSERT_GT(coded->tick, held);
        held = coded->tick;
        ++steps;
    }
    EXPECT_GT(steps, 1);
    EXPECT_LT(steps, 19) << "not one for each snapshot";
}

TEST(SnapshotFeed, has_a_keyframe_where_states_do_not_fit_a_datagram) {
    SnapshotFeed feed;
    feed.publish(snapshot_at(2, 1000));
    const EventLog log = log_from(2);
    EXPECT_EQ(feed.lead_on(0, log), nullptr);
    const auto keyframe = feed.keyframe();
    EXPECT_EQ(keyframe->tick, 2U);
    replication::SnapshotAssembler assembler;
    std::optional<replication::Snapshot> whole;
    for (const auto& bytes : keyframe->messages) {
        const auto message = replication::decode_server_message(bytes);
        ASSERT_TRUE(message);
        whole = assembler.add({}, std::get<replication::KeyframePart>(*message).part);
    }
    ASSERT_TRUE(whole);
    EXPECT_EQ(*whole, snapshot_at(2, 1000));
    feed.publish(snapshot_at(4, 1000));
    EXPECT_EQ(feed.keyframe(), keyframe) << "shared by who asks for it within a moment";
    feed.publish(snapshot_at(40, 1000));
    EXPECT_EQ(feed.keyframe()->tick, 40U);
}

}  // namespace
}  // namespace fts::server
