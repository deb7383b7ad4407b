#include "common/replication/delta.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "tests/replication/random_snapshots.h"

namespace fts::replication {
namespace {

using testing::chance;
using testing::MovingScene;
using testing::pick;
using testing::Rng;
using testing::wild_snapshot;
using testing::wild_successor;
using Parts = std::vector<std::vector<std::uint8_t>>;

constexpr std::size_t kDatagramBytes = 1100;

std::optional<Snapshot> assemble(const Snapshot& baseline, const Parts& parts) {
    SnapshotAssembler assembler;
    std::optional<Snapshot> whole;
    for (const auto& part : parts) {
        EXPECT_FALSE(whole) << "whole before its last part";
        whole = assembler.add(baseline, part);
    }
    EXPECT_EQ(assembler.malformed_count(), 0u);
    return whole;
}

std::size_t total_bytes(const Parts& parts) {
    std::size_t bytes = 0;
    for (const auto& part : parts) bytes += part.size();
    return bytes;
}

struct Pair {
    Snapshot before, now;
};
Pair wild_pair(Rng& rng, std::size_t max_balls) {
    const auto tick = static_cast<Tick>(pick(rng, 1, 100'000));
    const Snapshot before = wild_snapshot(rng, tick, max_balls);
    const auto later = static_cast<Tick>(pick(rng, 1, kMaxBaselineAgeTicks));
    return {before, wild_successor(rng, before, tick + later)};
}

TEST(Delta, AnySnapshotComesBackBitForBitWhateverTheBaselineAndThePartSize) {
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        SCOPED_TRACE(seed);
        Rng rng(seed);
        const Pair pair = wild_pair(rng, 120);
        for (const std::size_t max_bytes : {kMinPartBytes, std::size_t{97}, kDatagramBytes}) {
            SCOPED_TRACE(max_bytes);
            Parts parts = encode_delta(pair.before, pair.now, max_bytes);
            for (const auto& part : parts) ASSERT_LE(part.size(), max_bytes);
            std::shuffle(parts.begin(), parts.end(), rng);
            ASSERT_EQ(assemble(pair.before, parts), pair.now);
        }
    }
}

TEST(Delta, KeyframeNeedsNoBaseline) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        SCOPED_TRACE(seed);
        Rng rng(seed);
        const Snapshot now = wild_snapshot(rng, static_cast<Tick>(pick(rng, 0, 9999)), 100);
        const Parts parts = encode_delta(Snapshot{}, now, 200);
        for (const auto& part : parts) EXPECT_EQ(peek_part(part)->baseline_tick, 0u);
        ASSERT_EQ(assemble(Snapshot{}, parts), now);
    }
}

TEST(Delta, BytesPerBallOfSteeredScene) {
    MovingScene scene(7, 64, MovingScene::Drive::kSteered);
    std::vector<Snapshot> history;
    std::size_t bytes = 0, snapshots = 0;
    for (Tick tick = 1; tick <= 600; ++tick) {
        scene.tick();
        history.push_back(scene.snapshot(tick));
        if (tick <= 6 || tick % 2 != 0) continue;
        bytes += total_bytes(encode_delta(history[tick - 7], history[tick - 1], kDatagramBytes));
        ++snapshots;
    }
    const double each = static_cast<double>(bytes) / static_cast<double>(snapshots) / 64;
    const double keyframe =
        static_cast<double>(total_bytes(encode_delta(Snapshot{}, history.back(), kDatagramBytes))) /
        64;
    RecordProperty("bytes_per_ball", std::to_string(each));
    RecordProperty("keyframe_bytes_per_ball", std::to_string(keyframe));
    EXPECT_LE(each, 12.0);
}

}  // namespace
}  // namespace fts::replication
