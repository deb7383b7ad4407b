#include "server/stage_times.h"

#include <gtest/gtest.h>

namespace fts::server {
namespace {

class StageTimesTest : public testing::Test {
  protected:
    void pass(double duration_s) { now_s_ += duration_s; }
    const DurationHistogram& of(Stage stage) const {
        return times.histograms()[static_cast<std::size_t>(stage)];
    }

    StageTimes times{[this] { return now_s_; }};

  private:
    double now_s_ = 100.0;
};

TEST_F(StageTimesTest, a_stage_lasts_until_the_next_and_counts_once_a_tick_however_often_entered) {
    for (int tick = 0; tick < 3; ++tick) {
        for (int arena = 0; arena < 4; ++arena) {
            times.enter(Stage::kInputs);
            pass(0.001);
            times.enter(Stage::kMatch);
            pass(0.002);
        }
        times.end_tick();
        pass(5.0);
    }
    EXPECT_EQ(of(Stage::kInputs).count(), 3U);
    EXPECT_NEAR(of(Stage::kInputs).max_s(), 0.004, 1e-9);
    EXPECT_NEAR(of(Stage::kInputs).mean_s(), 0.004, 1e-9);
    EXPECT_NEAR(of(Stage::kMatch).max_s(), 0.008, 1e-9);
}

TEST_F(StageTimesTest, work_between_two_ticks_counts_for_the_one_that_follows) {
    times.enter(Stage::kReceive);
    pass(0.001);
    times.leave();
    pass(1.0);
    times.enter(Stage::kReceive);
    pass(0.002);
    times.end_tick();
    EXPECT_EQ(of(Stage::kReceive).count(), 1U);
    EXPECT_NEAR(of(Stage::kReceive).max_s(), 0.003, 1e-9);
}

TEST_F(StageTimesTest, the_sums_of_a_tick_begin_at_nothing) {
    times.enter(Stage::kLedger);
    pass(0.5);
    times.end_tick();
    times.end_tick();
    EXPECT_EQ(of(Stage::kLedger).count(), 2U);
    EXPECT_NEAR(of(Stage::kLedger).mean_s(), 0.25, 1e-9);
}

TEST(StageTimes, without_a_clock_measure_nothing) {
    StageTimes times{nullptr};
    times.enter(Stage::kMatch);
    times.leave();
    times.end_tick();
    for (const DurationHistogram& stage : times.histograms()) EXPECT_EQ(stage.count(), 0U);
}

}  // namespace
}  // namespace fts::server
