// Whatever was expected, what is decoded is what was encoded; and whatever arrives instead is
// refused.
#include "common/replication/snapshot_codec.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "common/replication/predictor.h"
#include "tests/replication/random_predictions.h"

namespace fts::replication {
namespace {

using testing::chance;
using testing::pick;
using testing::Rng;
using testing::wild_pair;
using testing::wild_prediction;
using Bytes = std::vector<std::uint8_t>;

struct Case {
    Prediction expected;
    std::vector<BallState> truth;
};

Case wild_case(Rng& rng, std::size_t max_balls) {
    const auto pair = wild_pair(rng, max_balls);
    return {wild_prediction(rng, pair.before, pair.now.tick), pair.now.balls};
}

std::optional<std::vector<BallState>> all_of(const Prediction& expected,
                                             const std::vector<Bytes>& parts) {
    std::vector<BallState> balls;
    for (const Bytes& part : parts) {
        const auto more = decode_balls(expected, part);
        if (!more) return std::nullopt;
        balls.insert(balls.end(), more->begin(), more->end());
    }
    return balls;
}

TEST(SnapshotCodec, GivesBackBallsThatJoinLeaveMoveAndChangeInAnyWay) {
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
        SCOPED_TRACE(seed);
        Rng rng(seed);
        const Case wild = wild_case(rng, 60);
        const auto parts = encode_balls(wild.expected, wild.truth, 20'000);
        EXPECT_EQ(all_of(wild.expected, parts), wild.truth);
    }
}

TEST(SnapshotCodec, GivesBackWhatNobodyExpected) {
    Rng rng(4);
    const Snapshot snapshot = testing::wild_snapshot(rng, 50, 200);
    const Prediction nothing{0, 50, {}};
    const auto parts = encode_balls(nothing, snapshot.balls, 1200);
    EXPECT_EQ(all_of(nothing, parts), snapshot.balls);
    EXPECT_EQ(peek_residual_part(parts.front())->baseline_tick, 0U);
}

TEST(SnapshotCodec, NeedsHardlyAByteForWhatIsAsExpected) {
    testing::MovingScene scene(1, 500, testing::MovingScene::Drive::kCoasting);
    const Snapshot now = scene.snapshot(100);
    Prediction expected{97, 100, {}};
    for (const BallState& ball : now.balls) {
        expected.balls.push_back(
            {.state = ball, .group = static_cast<std::uint32_t>(expected.balls.size())});
    }
    const auto parts = encode_balls(expected, now.balls, 1200);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_LT(parts.front().size(), 30U);
    EXPECT_EQ(all_of(expected, parts), now.balls);
}

TEST(SnapshotCodec, CutsWhatDoesNotFitIntoPartsThatStandAlone) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE(seed);
        Rng rng(seed);
        const Case wild = wild_case(rng, 900);
        const auto parts = encode_balls(wild.expected, wild.truth, kMinResidualPartBytes);
        std::uint32_t next_id = 0;
        for (const Bytes& part : parts) {
            EXPECT_LE(part.size(), kMinResidualPartBytes);
            const auto header = peek_residual_part(part);
            ASSERT_TRUE(header);
            EXPECT_EQ(header->first_id, next_id);
            next_id = header->last_id + 1U;
            const auto balls = decode_balls(wild.expected, part);
            ASSERT_TRUE(balls);
            std::vector<BallState> own;
            std::copy_if(wild.truth.begin(), wild.truth.end(), std::back_inserter(own),
                         [&](const BallState& ball) {
                             return ball.id >= header->first_id && ball.id <= header->last_id;
                         });
            EXPECT_EQ(*balls, own);
        }
        EXPECT_EQ(next_id, 0x10000U);
    }
}

TEST(SnapshotCodec, RefusesWhatIsCutShortLongerOrAltered) {
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
        SCOPED_TRACE(seed);
        Rng rng(seed);
        const Case wild = wild_case(rng, 30);
        const Bytes part = encode_balls(wild.expected, wild.truth, 20'000).front();
        for (std::size_t size = 0; size < part.size(); ++size) {
            const Bytes cut(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(size));
            ASSERT_FALSE(decode_balls(wild.expected, cut)) << size;
        }
        Bytes longer = part;
        longer.push_back(0);
        EXPECT_FALSE(decode_balls(wild.expected, longer));
        for (int i = 0; i < 300; ++i) {
            Bytes altered = part;
            const auto at =
                static_cast<std::size_t>(pick(rng, 0, static_cast<std::int64_t>(part.size()) - 1));
            altered[at] = static_cast<std::uint8_t>(altered[at] ^ (1U << pick(rng, 0, 7)));
            ASSERT_FALSE(decode_balls(wild.expected, altered)) << at;
        }
    }
}

TEST(SnapshotCodec, RefusesAPartMadeAgainstAnotherBaseline) {
    Rng rng(21);
    testing::MovingScene scene(2, 100, testing::MovingScene::Drive::kCoasting);
    const Snapshot before = scene.snapshot(97);
    for (int i = 0; i < 3; ++i) scene.tick();
    const Snapshot now = scene.snapshot(100);
    const Prediction expected = predict({}, {}, Foresight::kStraightLines, before.balls, 97, 100);
    const Bytes part = encode_balls(expected, now.balls, 4000).front();
    EXPECT_EQ(decode_balls(expected, part), now.balls);
    Prediction other = expected;
    other.balls[40].state.x += 1;
    EXPECT_FALSE(decode_balls(other, part));
    other = expected;
    other.baseline_tick = 96;
    EXPECT_FALSE(decode_balls(other, part));
    other = expected;
    other.tick = 101;
    EXPECT_FALSE(decode_balls(other, part));
}

TEST(SnapshotCodec, RefusesNoiseAndMakesNoMoreOfItThanItsBytesCanHold) {
    Rng rng(31);
    const Case wild = wild_case(rng, 200);
    const Bytes model = encode_balls(wild.expected, wild.truth, 20'000).front();
    for (int i = 0; i < 2000; ++i) {
        Bytes noise(model.begin(), model.begin() + 8);
        for (std::int64_t k = pick(rng, 0, 400); k > 0; --k) {
            noise.push_back(static_cast<std::uint8_t>(rng()));
        }
        ASSERT_FALSE(decode_balls(wild.expected, noise));
    }
}

}  // namespace
}  // namespace fts::replication
