#include "common/replication/arena_sketch.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "common/game/rules.h"
#include "common/replication/arena_replay.h"

namespace fts::replication {
namespace {

constexpr Tick kEverySecondTick = 2;

Course wide_disc() {
    return course_of(physics::Disc{50.0}, {});
}

BallState rolling(std::uint16_t id, double x_m, double vx_mps) {
    BallState ball;
    ball.id = id;
    ball.x = quantise(x_m, kPositionStepM);
    ball.y = quantise(2.0 * id, kPositionStepM);
    ball.vx = quantise(vx_mps, kVelocityStepMps);
    ball.radius = 2048;
    ball.mass = 65536;
    return ball;
}

Snapshot part_at(Tick tick, std::vector<BallState> balls) {
    Snapshot part;
    part.tick = tick;
    part.level = 1;
    part.phase = game::Phase::kPlaying;
    part.balls = std::move(balls);
    return part;
}

double x_m(const ArenaSketch& sketch, std::uint16_t id) {
    const auto& balls = sketch.now().balls;
    const auto ball = std::ranges::find(balls, id, &BallState::id);
    return ball == balls.end() ? -1e9 : ball->x * kPositionStepM;
}

TEST(ArenaSketch, ShowsWhatItWasToldAndMovesTheRestOn) {
    ArenaSketch sketch;
    sketch.tell(part_at(100, {rolling(1, 0.0, 6.0), rolling(2, -10.0, 3.0)}), wide_disc(),
                kEverySecondTick);
    EXPECT_EQ(sketch.now().tick, 100U);
    sketch.tell(part_at(160, {rolling(1, 20.0, 6.0)}), wide_disc(), kEverySecondTick);
    EXPECT_EQ(sketch.now().tick, 160U);
    EXPECT_DOUBLE_EQ(x_m(sketch, 1), 20.0) << "as told, wherever it was thought to be";
    EXPECT_NEAR(x_m(sketch, 2), -10.0 + 3.0, 1e-3) << "a second on";
    EXPECT_TRUE(is_canonical(sketch.now()));
}

TEST(ArenaSketch, TakesFromOlderPartsOnlyWhomItDoesNotHave) {
    ArenaSketch sketch;
    sketch.tell(part_at(130, {rolling(1, 5.0, 0.0)}), wide_disc(), kEverySecondTick);
    sketch.tell(part_at(100, {rolling(1, -7.0, 0.0), rolling(3, 0.0, 4.0)}), wide_disc(),
                kEverySecondTick);
    EXPECT_EQ(sketch.now().tick, 130U);
    EXPECT_DOUBLE_EQ(x_m(sketch, 1), 5.0);
    EXPECT_NEAR(x_m(sketch, 3), 2.0, 1e-3) << "half a second on";
}

TEST(ArenaSketch, GoesOnFromAWholeSnapshotAsItsReplayDoes) {
    Snapshot whole = part_at(200, {rolling(1, -3.0, 6.0), rolling(2, 3.0, -6.0)});
    whole.balls[1].y = whole.balls[0].y;  // they will hit
    ArenaSketch sketch;
    sketch.begin(whole);
    sketch.tell(part_at(260, {}), wide_disc(), kEverySecondTick);
    const Snapshot replayed = replay(wide_disc(), whole, 260, kEverySecondTick, {});
    EXPECT_EQ(sketch.now().balls, replayed.balls);
    EXPECT_FALSE(replayed.hits.empty());
    EXPECT_TRUE(sketch.now().hits.empty()) << "hits are not guessed";
}

TEST(ArenaSketch, ForgetsWhomNobodySpeaksOfAndFormerLevels) {
    ArenaSketch sketch;
    sketch.tell(part_at(100, {rolling(1, 0.0, 0.0), rolling(2, 9.0, 0.0)}), wide_disc(),
                kEverySecondTick);
    for (Tick tick = 102; tick <= 100 + ArenaSketch::kForgottenAfterTicks; tick += 100) {
        sketch.tell(part_at(tick, {rolling(1, 0.0, 0.0)}), wide_disc(), kEverySecondTick);
        EXPECT_EQ(sketch.now().balls.size(), 2U) << tick;
    }
    sketch.tell(part_at(102 + ArenaSketch::kForgottenAfterTicks, {rolling(1, 0.0, 0.0)}),
                wide_disc(), kEverySecondTick);
    EXPECT_EQ(sketch.now().balls.size(), 1U);
    Snapshot next_level = part_at(900, {rolling(8, 1.0, 0.0)});
    next_level.level = 2;
    sketch.tell(next_level, wide_disc(), kEverySecondTick);
    ASSERT_EQ(sketch.now().balls.size(), 1U);
    EXPECT_EQ(sketch.now().balls[0].id, 8);
    sketch.tell(part_at(890, {rolling(1, 0.0, 0.0)}), wide_disc(), kEverySecondTick);
    EXPECT_EQ(sketch.now().level, 2) << "late, and of a level that is over";
    EXPECT_EQ(sketch.now().balls.size(), 1U);
}

}  // namespace
}  // namespace fts::replication
