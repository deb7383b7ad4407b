#include "server/snapshot_feed.h"

#include <gtest/gtest.h>

#include "common/net/connection.h"
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

replication::Tick baseline_of(const SnapshotFeed::Parts& parts) {
    return replication::peek_part(parts.at(0))->baseline_tick;
}

TEST(SnapshotFeed, encodes_once_for_all_who_hold_the_same_baseline) {
    SnapshotFeed feed;
    feed.publish(snapshot_at(2));
    feed.publish(snapshot_at(4));
    const auto* first = &feed.parts_for(2);
    EXPECT_EQ(&feed.parts_for(2), first);
    EXPECT_EQ(feed.encoded_count(), 1U);
    EXPECT_EQ(baseline_of(*first), 2U);
    feed.parts_for(0);
    EXPECT_EQ(feed.encoded_count(), 2U);
}

TEST(SnapshotFeed, sends_a_keyframe_to_who_holds_nothing_of_use) {
    SnapshotFeed feed;
    for (replication::Tick tick = 2; tick <= 400; tick += 2) feed.publish(snapshot_at(tick));
    EXPECT_EQ(baseline_of(feed.parts_for(0)), 0U);
    EXPECT_EQ(baseline_of(feed.parts_for(2)), 0U) << "forgotten by now";
    EXPECT_EQ(baseline_of(feed.parts_for(397)), 0U) << "never was";
    EXPECT_EQ(baseline_of(feed.parts_for(400)), 0U) << "is the newest itself";
    EXPECT_EQ(baseline_of(feed.parts_for(398)), 398U);
}

TEST(SnapshotFeed, makes_parts_that_decode_and_fit_a_datagram) {
    SnapshotFeed feed;
    feed.publish(snapshot_at(2, 1000));
    feed.publish(snapshot_at(4, 1000));
    for (const replication::Tick held : {0U, 2U}) {
        replication::SnapshotAssembler assembler;
        std::optional<replication::Snapshot> whole;
        const auto baseline = held ? snapshot_at(held, 1000) : replication::Snapshot{};
        for (const auto& part : feed.parts_for(held)) {
            EXPECT_LT(part.size(), net::kMaxPayloadBytes);
            whole = assembler.add(baseline, part);
        }
        ASSERT_TRUE(whole);
        EXPECT_EQ(*whole, snapshot_at(4, 1000));
    }
}

}  // namespace
}  // namespace fts::server
