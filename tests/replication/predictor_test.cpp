// Both ends expect the same; what is expected comes true where nobody steers; and where the server
// keeps to the lattice it comes true to the last bit.
#include "common/replication/predictor.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/game/input.h"
#include "common/physics/generator.h"
#include "common/replication/state_digest.h"
#include "tests/replication/random_snapshots.h"

namespace fts::replication {
namespace {

using testing::chance;
using testing::pick;
using testing::Rng;

constexpr Tick kSnapshotTicks = 3;

Course box_course() {
    Course course;
    course.scene.walls = physics::Walls{{0.0, 0.0}, {60.0, 40.0}};
    course.lattice = {1.0 / 64.0, 10.0 / 64.0};
    course.control_of = [](const BallState& ball) {
        physics::Control<double> control;
        if (ball.kind == 0) return control;
        control.acceleration_mps2 =
            40.0 * game::thrust_of({.thrust_x = ball.thrust_x, .thrust_y = ball.thrust_y});
        control.drag_per_s = 2.0;
        return control;
    };
    return course;
}

std::vector<BallState> balls_in_box(std::size_t count, std::uint64_t seed) {
    const Course course = box_course();
    physics::Generator generator;
    generator.seed = seed;
    generator.count = static_cast<std::int64_t>(count);
    generator.speed_rms_mps = 12.0;
    const auto scene = std::get<physics::Scene>(physics::fill(course.scene, generator));
    Rng rng(seed);
    std::vector<BallState> balls;
    for (const physics::BodyDef& body : scene.bodies) {
        BallState ball;
        ball.id = static_cast<std::uint16_t>(3 * balls.size());
        ball.x = quantise(body.position_m.x(), course.lattice.position_step_m);
        ball.y = quantise(body.position_m.y(), course.lattice.position_step_m);
        ball.vx = quantise(body.velocity_mps.x(), course.lattice.velocity_step_mps);
        ball.vy = quantise(body.velocity_mps.y(), course.lattice.velocity_step_mps);
        ball.radius = static_cast<std::uint16_t>(quantise(0.5, kRadiusStepM));
        ball.mass = static_cast<std::uint32_t>(quantise(1.0, kMassStepKg));
        ball.kind = chance(rng, 30) ? 1 : 0;
        if (ball.kind == 1) ball.thrust_x = chance(rng, 50) ? 127 : -127;
        balls.push_back(ball);
    }
    return balls;
}

std::uint32_t digest_of(const std::vector<BallState>& balls) {
    StateDigest digest;
    for (const BallState& ball : balls) digest.add(ball);
    return digest.value();
}

std::vector<BallState> states_of(const Prediction& prediction) {
    std::vector<BallState> states;
    for (const Expectation& ball : prediction.balls) states.push_back(ball.state);
    return states;
}

TEST(Predictor, KnowsToTheLastBitWhatAServerOnTheLatticeDoes) {
    const Course course = box_course();
    LatticeWorld server(course, balls_in_box(120, 3));
    server.snap();
    const std::vector<BallState> baseline = server.balls();
    for (Tick tick = 1; tick <= 30; ++tick) {
        server.advance(course.tick_s);
        if (tick % kSnapshotTicks != 0) continue;
        server.snap();
        const Prediction prediction =
            predict(course, {.unforeseen_mps2 = 40.0, .snapshot_ticks = kSnapshotTicks},
                    Foresight::kControlsOnLattice, baseline, 300, 300 + tick);
        ASSERT_EQ(states_of(prediction), server.balls()) << tick;
    }
}

// The mean square of what is left of place and velocity, in steps.
double squares_left(const Prediction& prediction, const std::vector<BallState>& truth) {
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const BallState& expected = prediction.balls[i].state;
        sum += std::pow(truth[i].x - expected.x, 2) + std::pow(truth[i].y - expected.y, 2) +
               std::pow(truth[i].vx - expected.vx, 2) + std::pow(truth[i].vy - expected.vy, 2);
    }
    return sum / (4.0 * static_cast<double>(truth.size()));
}

TEST(Predictor, IsNearerToTheTruthTheMoreItKnows) {
    const Course course = box_course();
    LatticeWorld server(course, balls_in_box(300, 5));
    for (int i = 0; i < 60; ++i) server.advance(course.tick_s);
    const std::vector<BallState> baseline = server.balls();
    for (int i = 0; i < 6; ++i) server.advance(course.tick_s);
    const std::vector<BallState> truth = server.balls();
    const auto left_with = [&](Foresight foresight) {
        return squares_left(predict(course, {}, foresight, baseline, 300, 306), truth);
    };
    EXPECT_LT(left_with(Foresight::kCollisions), 0.5 * left_with(Foresight::kStraightLines));
    EXPECT_LT(left_with(Foresight::kControls), 0.5 * left_with(Foresight::kCollisions));
}

// By class of doubt, what is left must be as wide as the class says, within a factor that leaves
// room for what is only of first order.
TEST(Predictor, KnowsHowFarOffItMayBe) {
    Course course = box_course();
    course.control_of = nullptr;
    std::array<double, kDoubts> squares{};
    std::array<int, kDoubts> counts{};
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        LatticeWorld server(course, balls_in_box(300, seed));
        for (int i = 0; i < 50; ++i) server.advance(course.tick_s);
        const std::vector<BallState> baseline = server.balls();
        for (int i = 0; i < 6; ++i) server.advance(course.tick_s);
        const std::vector<BallState> truth = server.balls();
        const Prediction prediction =
            predict(course, {}, Foresight::kCollisions, baseline, 300, 306);
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const Expectation& ball = prediction.balls[i];
            const double off =
                std::pow(truth[i].vx - ball.state.vx, 2) + std::pow(truth[i].vy - ball.state.vy, 2);
            // What a missed hit leaves is no measure of the others.
            if (off > 100.0 * variance_of(ball.speed_doubt)) continue;
            squares[ball.speed_doubt] += off / 2.0;
            ++counts[ball.speed_doubt];
        }
    }
    int judged = 0;
    for (std::size_t doubt = 1; doubt < kDoubts; ++doubt) {
        if (counts[doubt] < 60) continue;
        ++judged;
        const double variance = squares[doubt] / counts[doubt];
        const double expected = 1.5 * variance_of(static_cast<Doubt>(doubt));
        EXPECT_GT(variance, expected / 6.0) << "doubt " << doubt << ", of " << counts[doubt];
        EXPECT_LT(variance, expected * 6.0) << "doubt " << doubt << ", of " << counts[doubt];
    }
    EXPECT_GE(judged, 3);
}

TEST(Predictor, MakesValidBodiesOfWhateverABaselineHolds) {
    Rng rng(9);
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE(seed);
        std::vector<BallState> baseline = testing::wild_snapshot(rng, 40, 25).balls;
        const Prediction prediction =
            predict(box_course(), {}, Foresight::kControlsOnLattice, baseline, 40, 46);
        ASSERT_EQ(prediction.balls.size(), baseline.size());
        for (const Expectation& ball : prediction.balls) {
            EXPECT_GE(ball.state.x, 0);
            EXPECT_LE(ball.state.x, 60 * 64);
        }
    }
}

TEST(Predictor, KeepsEveryBallOfAnOpenCourseWhateverABaselineHolds) {
    Course open = box_course();
    open.scene.walls.reset();
    Rng rng(10);
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE(seed);
        const std::vector<BallState> baseline = testing::wild_snapshot(rng, 40, 25).balls;
        const std::vector<BallState> states =
            states_of(predict(open, {}, Foresight::kControlsOnLattice, baseline, 40, 46));
        ASSERT_EQ(states.size(), baseline.size());
        for (std::size_t i = 0; i < states.size(); ++i) EXPECT_EQ(states[i].id, baseline[i].id);
    }
}

#ifndef NDEBUG
TEST(LatticeWorldDeathTest, TakesNoCourseOnWhichBallsComeBackFromTheOtherSide) {
    Course periodic;
    periodic.scene.periodic = physics::Periodic{{0.0, 0.0}, {10.0, 10.0}};
    EXPECT_DEATH(LatticeWorld(periodic, {}), "periodic");
}
#endif

// The same on every compiler, processor and optimisation level, or the two ends would part.
TEST(Predictor, GivesTheSameBitsEverywhere) {
    const std::vector<BallState> baseline = balls_in_box(250, 8);
    EXPECT_EQ(digest_of(states_of(
                  predict(box_course(), {}, Foresight::kControlsOnLattice, baseline, 60, 90))),
              3010541504U);
    std::uint32_t doubts = 0;
    for (const Expectation& ball :
         predict(box_course(), {}, Foresight::kCollisions, baseline, 60, 69).balls) {
        doubts = doubts * 31 + ball.speed_doubt + 3U * ball.place_doubt + 7U * ball.group +
                 static_cast<std::uint32_t>(ball.lever) + static_cast<std::uint32_t>(ball.lean_x);
    }
    EXPECT_EQ(doubts, 3546564354U);
}

}  // namespace
}  // namespace fts::replication
