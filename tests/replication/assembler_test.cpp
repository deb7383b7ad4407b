#include <algorithm>

#include <gtest/gtest.h>

#include "common/replication/delta.h"
#include "tests/replication/random_snapshots.h"

namespace fts::replication {
namespace {

using testing::Rng;
using testing::wild_snapshot;
using testing::wild_successor;
using Parts = std::vector<std::vector<std::uint8_t>>;

constexpr std::size_t kPartBytes = 120;

// A baseline at tick 100, and what came after it, in several parts each.
struct Stream {
    Rng rng{17};
    Snapshot baseline = wild_snapshot(rng, 100, 60);
    Snapshot at(Tick tick) { return wild_successor(rng, baseline, tick); }
    Parts parts_of(const Snapshot& snapshot) {
        Parts parts = encode_delta(baseline, snapshot, kPartBytes);
        EXPECT_GE(parts.size(), 3U);
        return parts;
    }
};

TEST(SnapshotAssembler, GivesNothingWhileAPartIsMissing) {
    Stream stream;
    const Snapshot now = stream.at(110);
    const Parts parts = stream.parts_of(now);
    for (std::size_t missing = 0; missing < parts.size(); ++missing) {
        SCOPED_TRACE(missing);
        SnapshotAssembler assembler;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (i == missing) continue;
            EXPECT_FALSE(assembler.add(stream.baseline, parts[i]));
        }
        EXPECT_EQ(assembler.add(stream.baseline, parts[missing]), now);
    }
}

TEST(SnapshotAssembler, RepeatedPartsChangeNothing) {
    Stream stream;
    const Snapshot now = stream.at(110);
    const Parts parts = stream.parts_of(now);
    SnapshotAssembler assembler;
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
        EXPECT_FALSE(assembler.add(stream.baseline, parts[i]));
        EXPECT_FALSE(assembler.add(stream.baseline, parts[i]));
    }
    EXPECT_EQ(assembler.add(stream.baseline, parts.back()), now);
    EXPECT_FALSE(assembler.add(stream.baseline, parts.back())) << "a tick is completed once";
    EXPECT_EQ(assembler.malformed_count(), 0U);
}

TEST(SnapshotAssembler, InterleavedTicksAreKeptApart) {
    Stream stream;
    const Snapshot first = stream.at(110), second = stream.at(112);
    const Parts early = stream.parts_of(first), late = stream.parts_of(second);
    SnapshotAssembler assembler;
    const std::size_t shared = std::min(early.size(), late.size()) - 1;
    for (std::size_t i = 0; i < shared; ++i) {
        EXPECT_FALSE(assembler.add(stream.baseline, late[i]));
        EXPECT_FALSE(assembler.add(stream.baseline, early[i]));
    }
    for (std::size_t i = shared; i + 1 < early.size(); ++i) {
        EXPECT_FALSE(assembler.add(stream.baseline, early[i]));
    }
    for (std::size_t i = shared; i + 1 < late.size(); ++i) {
        EXPECT_FALSE(assembler.add(stream.baseline, late[i]));
    }
    EXPECT_EQ(assembler.add(stream.baseline, early.back()), first);
    EXPECT_EQ(assembler.add(stream.baseline, late.back()), second);
}

TEST(SnapshotAssembler, TicksOlderThanACompletedOneAreOver) {
    Stream stream;
    const Snapshot first = stream.at(110), second = stream.at(112);
    const Parts early = stream.parts_of(first), late = stream.parts_of(second);
    SnapshotAssembler assembler;
    for (std::size_t i = 0; i + 1 < early.size(); ++i) assembler.add(stream.baseline, early[i]);
    for (std::size_t i = 0; i + 1 < late.size(); ++i) assembler.add(stream.baseline, late[i]);
    EXPECT_EQ(assembler.add(stream.baseline, late.back()), second);
    EXPECT_FALSE(assembler.add(stream.baseline, early.back()));
    EXPECT_EQ(assembler.malformed_count(), 0U);
}

TEST(SnapshotAssembler, MalformedPartIsCountedAndDoesNoHarm) {
    Stream stream;
    const Snapshot now = stream.at(110);
    const Parts parts = stream.parts_of(now);
    SnapshotAssembler assembler;
    auto broken = parts.front();
    broken.pop_back();
    EXPECT_FALSE(assembler.add(stream.baseline, broken));
    EXPECT_FALSE(assembler.add(stream.baseline, {}));
    EXPECT_FALSE(assembler.add(Snapshot{}, parts.front())) << "not its baseline";
    EXPECT_EQ(assembler.malformed_count(), 3U);
    std::optional<Snapshot> whole;
    for (const auto& part : parts) whole = assembler.add(stream.baseline, part);
    EXPECT_EQ(whole, now);
    EXPECT_EQ(assembler.malformed_count(), 3U);
}

TEST(SnapshotAssembler, PartsOfDifferentSnapshotsOfOneTickDoNotMix) {
    Stream stream;
    const Snapshot now = stream.at(110);
    Snapshot other = now;
    other.level = static_cast<std::uint16_t>(other.level + 1);
    const Parts parts = stream.parts_of(now), strangers = stream.parts_of(other);
    SnapshotAssembler assembler;
    EXPECT_FALSE(assembler.add(stream.baseline, parts.front()));
    EXPECT_FALSE(assembler.add(stream.baseline, strangers.back()));
    EXPECT_EQ(assembler.malformed_count(), 1U);

    const Parts coarser = encode_delta(stream.baseline, now, 3 * kPartBytes);
    ASSERT_NE(coarser.size(), parts.size());
    EXPECT_FALSE(assembler.add(stream.baseline, coarser.back()));
    EXPECT_EQ(assembler.malformed_count(), 2U);
}

TEST(SnapshotAssembler, GivesUpTheOldestOfTooManyUnfinishedTicks) {
    Stream stream;
    std::vector<Snapshot> snapshots;
    std::vector<Parts> parts;
    SnapshotAssembler assembler;
    for (Tick i = 0; i <= SnapshotAssembler::kMaxPendingTicks; ++i) {
        snapshots.push_back(stream.at(110 + i));
        parts.push_back(stream.parts_of(snapshots.back()));
        EXPECT_FALSE(assembler.add(stream.baseline, parts.back().front()));
    }
    const auto rest_of = [&](std::size_t i) {
        std::optional<Snapshot> whole;
        for (std::size_t k = 1; k < parts[i].size(); ++k) {
            whole = assembler.add(stream.baseline, parts[i][k]);
        }
        return whole;
    };
    EXPECT_FALSE(rest_of(0)) << "its first part was given up";
    EXPECT_EQ(rest_of(1), snapshots[1]);
    EXPECT_EQ(rest_of(SnapshotAssembler::kMaxPendingTicks), snapshots.back());
    EXPECT_EQ(assembler.malformed_count(), 0U);
}

TEST(SnapshotAssembler, TickZeroIsATickLikeAnyOther) {
    Snapshot nothing_yet;
    nothing_yet.level = 1;
    SnapshotAssembler assembler;
    const Parts parts = encode_delta(Snapshot{}, nothing_yet, kPartBytes);
    EXPECT_EQ(assembler.add(Snapshot{}, parts.front()), nothing_yet);
    EXPECT_FALSE(assembler.add(Snapshot{}, parts.front()));
}

}  // namespace
}  // namespace fts::replication
