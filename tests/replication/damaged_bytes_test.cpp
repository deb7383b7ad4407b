// Whatever arrives is a canonical value or nothing; what it becomes is a value like any other,
// which can be encoded and decoded again.
#include <algorithm>

#include <gtest/gtest.h>

#include "common/replication/delta.h"
#include "common/replication/delta_format.h"
#include "common/replication/wire.h"
#include "tests/replication/random_snapshots.h"

namespace fts::replication {
namespace {

using delta_format::kDigestBytes;
using delta_format::with_digest;
using testing::pick;
using testing::Rng;
using testing::SnapshotPair;
using testing::wild_pair;
using Bytes = std::vector<std::uint8_t>;

Bytes body_of(const Bytes& part) {
    return {part.begin(), part.end() - static_cast<std::ptrdiff_t>(kDigestBytes)};
}

void expect_sound(const Snapshot& baseline, const Bytes& bytes) {
    const auto snapshot = decode_part(baseline, bytes);
    if (!snapshot) return;
    ASSERT_TRUE(is_canonical(*snapshot));
    ASSERT_LE(snapshot->balls.size(), baseline.balls.size() + bytes.size());
    ASSERT_LE(snapshot->coins.size(), baseline.coins.size() + bytes.size());
    ASSERT_LE(snapshot->hits.size(), bytes.size());
    const auto again = encode_delta(baseline, *snapshot, 100'000);
    ASSERT_EQ(again.size(), 1U);
    ASSERT_EQ(decode_part(baseline, again.front()), snapshot);
}

TEST(DamagedPart, CutShortAnywhereIsNothing) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE(seed);
        Rng rng(seed);
        const SnapshotPair pair = wild_pair(rng, 30);
        for (const Bytes& part : encode_delta(pair.before, pair.now, 400)) {
            for (std::size_t size = 0; size < part.size(); ++size) {
                const Bytes cut(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(size));
                ASSERT_FALSE(decode_part(pair.before, cut)) << size;
            }
        }
    }
}

TEST(DamagedPart, WithBytesToSpareIsNothing) {
    Rng rng(8);
    const SnapshotPair pair = wild_pair(rng, 30);
    Bytes part = encode_delta(pair.before, pair.now, 10'000).front();
    ASSERT_TRUE(decode_part(pair.before, part));
    part.push_back(0);
    EXPECT_FALSE(decode_part(pair.before, part));
}

// Whoever alters a part can make a digest that goes with it.
TEST(DamagedPart, WithAnyBitFlippedIsNothingAndWithANewDigestSoundOrNothing) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        Rng rng(seed);
        const SnapshotPair pair = wild_pair(rng, 20);
        for (Bytes part : encode_delta(pair.before, pair.now, 300)) {
            for (std::size_t bit = 0; bit < 8 * part.size(); ++bit) {
                const auto mask = static_cast<std::uint8_t>(1U << (bit % 8));
                part[bit / 8] ^= mask;
                ASSERT_FALSE(decode_part(pair.before, part)) << bit;
                const Bytes again = with_digest(body_of(part));
                ASSERT_NO_FATAL_FAILURE(expect_sound(pair.before, again)) << bit;
                part[bit / 8] ^= mask;
            }
        }
    }
}

// Random bytes behind a header that is in order, which random bytes alone would never make.
TEST(DamagedPart, WithARandomBodyIsSoundOrNothing) {
    const Bytes kNothingMore = {0xFF, 0xFF, 0};  // the ends of two lists, and no hits
    std::size_t accepted = 0;
    for (std::uint64_t seed = 1; seed <= 20'000; ++seed) {
        SCOPED_TRACE(seed);
        Rng rng(seed);
        SnapshotPair pair = wild_pair(rng, 10);
        for (BallState& ball : pair.before.balls) {
            ball.vx = ball.vy = 0;
        }
        pair.now = pair.before;
        pair.now.hits.clear();
        ++pair.now.tick;
        Bytes part = body_of(encode_delta(pair.before, pair.now, 400).front());
        ASSERT_TRUE(std::equal(kNothingMore.rbegin(), kNothingMore.rend(), part.rbegin()));
        part.resize(part.size() - kNothingMore.size());
        for (auto more = pick(rng, 0, 12); more > 0; --more) {
            part.push_back(static_cast<std::uint8_t>(pick(rng, 0, 255)));
        }
        part.insert(part.end(), kNothingMore.begin(), kNothingMore.end());
        part = with_digest(part);
        ASSERT_NO_FATAL_FAILURE(expect_sound(pair.before, part));
        accepted += decode_part(pair.before, part).has_value();
    }
    EXPECT_GT(accepted, 1000U) << "the test no longer reaches what it is about";
}

TEST(DamagedPart, RandomBytesAreSoundOrNothing) {
    for (std::uint64_t seed = 1; seed <= 20'000; ++seed) {
        SCOPED_TRACE(seed);
        Rng rng(seed);
        Bytes bytes(static_cast<std::size_t>(pick(rng, 0, 60)));
        for (auto& byte : bytes) byte = static_cast<std::uint8_t>(rng());
        ASSERT_NO_FATAL_FAILURE(expect_sound(Snapshot{}, with_digest(bytes)));
        decode_client_message(bytes);
        decode_server_message(bytes);
        decode_input_packet(bytes);
        decode_snapshot_packet(bytes);
    }
}

TEST(DamagedPart, ClaimOfManyHitsIsNotBelieved) {
    Snapshot now;
    now.tick = 9;
    Bytes part = body_of(encode_delta(Snapshot{}, now, 400).front());
    ASSERT_TRUE(decode_part(Snapshot{}, with_digest(part)));
    part.back() = 127;
    EXPECT_FALSE(decode_part(Snapshot{}, with_digest(part)));
}

TEST(DamagedPart, HeaderOutOfItsRangesIsNothing) {
    const auto peek = [](Bytes bytes) { return peek_part(bytes); };
    EXPECT_TRUE(peek({9, 8, 0}));
    EXPECT_FALSE(peek({9, 9, 0})) << "a baseline of tick 0";
    EXPECT_FALSE(peek({9, 10, 0})) << "a baseline from before the beginning";
    EXPECT_FALSE(peek({9, 8, 0x20})) << "an unknown flag";
    EXPECT_TRUE(peek({9, 8, 0x10, 1, 2}));
    EXPECT_FALSE(peek({9, 8, 0x10, 2, 2})) << "the third part of two";
    EXPECT_FALSE(peek({9, 8, 0x10, 0, 1})) << "a single part says nothing of parts";
    EXPECT_FALSE(peek({9, 8, 0x10, 0, 0}));
    EXPECT_FALSE(peek({0x89, 0x00, 8, 0})) << "a varint longer than it needs to be";
    EXPECT_FALSE(peek({0xFF, 0xFF, 0xFF, 0xFF, 0x1F, 8, 0})) << "a tick of more than 32 bits";
    EXPECT_FALSE(peek({}));
}

}  // namespace
}  // namespace fts::replication
