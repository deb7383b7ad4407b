#include "common/replication/snapshot.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/replication/snapshot_history.h"
#include "tests/replication/random_snapshots.h"

namespace fts::replication {
namespace {

TEST(Quantise, RoundsToTheNearestStepOnBothSidesOfZero) {
    EXPECT_EQ(quantise(1.0, kPositionStepM), 65536);
    EXPECT_EQ(quantise(0.49 * kPositionStepM, kPositionStepM), 0);
    EXPECT_EQ(quantise(0.5 * kPositionStepM, kPositionStepM), 1);
    EXPECT_EQ(quantise(-0.5 * kPositionStepM, kPositionStepM), -1);
    EXPECT_EQ(quantise(-3.2 * kVelocityStepMps, kVelocityStepMps), -3);
}

TEST(Quantise, IsOffByAtMostHalfAStepWithinTheRange) {
    testing::Rng rng(3);
    for (int i = 0; i < 1000; ++i) {
        const double value =
            static_cast<double>(testing::pick(rng, -2'000'000'000, 2'000'000'000)) / 65'537;
        ASSERT_TRUE(in_range(value, kPositionStepM));
        const double back = dequantise(quantise(value, kPositionStepM), kPositionStepM);
        ASSERT_LE(std::abs(back - value), kPositionStepM / 2) << value;
    }
}

TEST(Quantise, WhatIsAlreadyOnTheLatticeStaysBitForBit) {
    for (const std::int32_t steps : {0, 1, -1, 12'345, std::numeric_limits<std::int32_t>::min(),
                                     std::numeric_limits<std::int32_t>::max()}) {
        EXPECT_EQ(quantise(dequantise(steps, kPositionStepM), kPositionStepM), steps);
    }
}

TEST(Quantise, ClampsWhatIsOutOfRangeAndInRangeSaysSo) {
    const double edge_m = dequantise(std::numeric_limits<std::int32_t>::max(), kPositionStepM);
    EXPECT_TRUE(in_range(edge_m, kPositionStepM));
    EXPECT_FALSE(in_range(edge_m + kPositionStepM, kPositionStepM));
    EXPECT_EQ(quantise(edge_m + 1, kPositionStepM), std::numeric_limits<std::int32_t>::max());
    EXPECT_EQ(quantise(std::numeric_limits<double>::infinity(), kPositionStepM),
              std::numeric_limits<std::int32_t>::max());
    EXPECT_EQ(quantise(-std::numeric_limits<double>::infinity(), kPositionStepM),
              std::numeric_limits<std::int32_t>::min());
    EXPECT_FALSE(in_range(-std::numeric_limits<double>::infinity(), kPositionStepM));
    EXPECT_EQ(quantise(std::numeric_limits<double>::quiet_NaN(), kPositionStepM), 0);
    EXPECT_FALSE(in_range(std::numeric_limits<double>::quiet_NaN(), kPositionStepM));
}

Snapshot with_balls(std::initializer_list<std::uint16_t> ids) {
    Snapshot snapshot;
    for (const std::uint16_t id : ids) {
        BallState ball;
        ball.id = id;
        snapshot.balls.push_back(ball);
    }
    return snapshot;
}

TEST(Canonical, ListsAscendWithoutRepeats) {
    EXPECT_TRUE(is_canonical(with_balls({})));
    EXPECT_TRUE(is_canonical(with_balls({0, 3, 65535})));
    EXPECT_FALSE(is_canonical(with_balls({3, 3})));
    EXPECT_FALSE(is_canonical(with_balls({4, 3})));

    Snapshot coins;
    coins.coins = {{.id = 9}, {.id = 2}};
    EXPECT_FALSE(is_canonical(coins));
}

TEST(Canonical, HitsAreInOrderAndTheSamePairMayMeetTwiceInATick) {
    Snapshot snapshot;
    snapshot.hits = {{.tick = 5, .a = 2, .b = 3}, {.tick = 5, .a = 2, .b = 3}, {.tick = 6, .a = 1}};
    EXPECT_TRUE(is_canonical(snapshot));
    std::swap(snapshot.hits.front(), snapshot.hits.back());
    EXPECT_FALSE(is_canonical(snapshot));
}

TEST(Canonical, EveryEnumIsOneOfItsValues) {
    Snapshot snapshot = with_balls({1});
    snapshot.balls[0].behaviour = static_cast<std::uint8_t>(kLastBehaviour);
    EXPECT_TRUE(is_canonical(snapshot));
    ++snapshot.balls[0].behaviour;
    EXPECT_FALSE(is_canonical(snapshot));
    snapshot = with_balls({1});
    snapshot.balls[0].kind = 2;
    EXPECT_FALSE(is_canonical(snapshot));
    snapshot = with_balls({1});
    snapshot.phase = static_cast<game::Phase>(4);
    EXPECT_FALSE(is_canonical(snapshot));
}

std::shared_ptr<const Snapshot> at(Tick tick, std::uint16_t level = 0) {
    Snapshot snapshot;
    snapshot.tick = tick;
    snapshot.level = level;
    return std::make_shared<const Snapshot>(snapshot);
}

TEST(SnapshotHistory, HoldsTheNewestAndForgetsTheOldest) {
    SnapshotHistory history;
    EXPECT_EQ(history.newest(), nullptr);
    EXPECT_EQ(history.find(0), nullptr);

    const Tick last = 3 * kMaxBaselineAgeTicks;
    for (Tick tick = 2; tick <= last; tick += 2) history.add(at(tick));
    for (Tick tick = 1; tick <= last; ++tick) {
        const auto newest = history.newest()->tick;
        const bool held = tick % 2 == 0 && newest - tick <= kMaxBaselineAgeTicks;
        EXPECT_EQ(history.find(tick) != nullptr, held) << tick;
    }
    history.clear();
    EXPECT_EQ(history.newest(), nullptr);
    EXPECT_EQ(history.find(last - 1), nullptr);
}

TEST(SnapshotHistory, LateArrivalsFindTheirPlaceUnlessTheyAreTooOld) {
    SnapshotHistory history;
    const Tick newest = 1000;
    for (Tick tick = newest - 20; tick <= newest; tick += 2) history.add(at(tick));
    history.add(at(newest - kMaxBaselineAgeTicks));
    history.add(at(newest - kMaxBaselineAgeTicks - 1));
    EXPECT_NE(history.find(newest - kMaxBaselineAgeTicks), nullptr);
    EXPECT_EQ(history.find(newest - kMaxBaselineAgeTicks - 1), nullptr);
    EXPECT_EQ(history.newest()->tick, newest);
    EXPECT_EQ(history.newest_up_to(newest - 1)->tick, newest - 2);
    EXPECT_EQ(history.newest_up_to(newest - 21)->tick, newest - kMaxBaselineAgeTicks);
    EXPECT_EQ(history.newest_up_to(newest - kMaxBaselineAgeTicks - 1), nullptr);
}

TEST(SnapshotHistory, TheSameTickIsReplaced) {
    SnapshotHistory history;
    history.add(at(7, 1));
    history.add(at(7, 2));
    EXPECT_EQ(history.find(7)->level, 2);
}

TEST(SnapshotHistory, WhatWasFoundOutlivesItsPlace) {
    SnapshotHistory history;
    history.add(at(1, 42));
    const auto held = history.find(1);
    history.add(at(2 + kMaxBaselineAgeTicks));
    EXPECT_EQ(history.find(1), nullptr);
    EXPECT_EQ(held->level, 42);
}

}  // namespace
}  // namespace fts::replication
