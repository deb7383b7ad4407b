#include "server/tick_clock.h"

#include <random>

#include <gtest/gtest.h>

#include "server/duration_histogram.h"
#include "server/limits.h"

namespace fts::server {
namespace {

constexpr double kTickS = 1.0 / 64.0;  // exact in binary, so that tests may speak of equal times

TEST(TickClock, starts_with_the_first_call) {
    TickClock clock(kTickS);
    EXPECT_EQ(clock.due(1234.5), 0);
    EXPECT_EQ(clock.due(1234.5 + 0.9 * kTickS), 0);
    EXPECT_EQ(clock.due(1234.5 + kTickS), 1);
    EXPECT_DOUBLE_EQ(clock.next_tick_s(), 1234.5 + 2 * kTickS);
}

TEST(TickClock, loses_and_invents_no_tick_however_irregularly_it_is_asked) {
    std::mt19937_64 random(5);
    TickClock clock(kTickS);
    double now_s = 50.0;
    clock.due(now_s);
    int ticks = 0;
    for (int i = 0; i < 10'000; ++i) {
        now_s += kTickS * static_cast<double>(random() % 1000) / 400.0;
        const int due = clock.due(now_s);
        ASSERT_LE(due, kMaxCatchUpTicks);
        ticks += due;
        ASSERT_EQ(ticks, static_cast<int>((now_s - 50.0) / kTickS));
        ASSERT_GT(clock.next_tick_s(), now_s);
    }
    EXPECT_EQ(clock.dropped_ticks(), 0U);
}

TEST(TickClock, makes_up_for_a_short_delay) {
    TickClock clock(kTickS);
    clock.due(0.0);
    EXPECT_EQ(clock.due(1 * kTickS), 1);
    EXPECT_EQ(clock.late_ticks(), 0U);
    EXPECT_EQ(clock.due((1 + kMaxCatchUpTicks) * kTickS), kMaxCatchUpTicks);
    EXPECT_EQ(clock.late_ticks(), kMaxCatchUpTicks - 1U) << "the last of them is in time";
    EXPECT_EQ(clock.overruns(), 0U);
}

TEST(TickClock, drops_and_counts_what_a_long_delay_leaves_beyond_the_limit) {
    TickClock clock(kTickS);
    clock.due(0.0);
    EXPECT_EQ(clock.due(100 * kTickS), kMaxCatchUpTicks);
    EXPECT_EQ(clock.overruns(), 1U);
    EXPECT_EQ(clock.dropped_ticks(), 100U - kMaxCatchUpTicks);
    EXPECT_EQ(clock.late_ticks(), kMaxCatchUpTicks - 1U);
    EXPECT_EQ(clock.due(100.5 * kTickS), 0) << "never races to catch up";
    EXPECT_EQ(clock.due(101 * kTickS), 1);
}

TEST(TickClock, ignores_time_that_runs_backwards) {
    TickClock clock(kTickS);
    clock.due(10.0);
    EXPECT_EQ(clock.due(10.0 + 3 * kTickS), 3);
    EXPECT_EQ(clock.due(9.0), 0);
    EXPECT_EQ(clock.due(10.0 + 4 * kTickS), 1);
}

TEST(TickClock, speaks_of_overruns_at_most_once_a_second_and_forgets_none) {
    TickClock clock(kTickS);
    clock.due(0.0);
    EXPECT_FALSE(clock.overrun_notice(0.0));
    std::uint64_t noticed = 0;
    int notices = 0;
    double now_s = 0.0;
    for (int i = 0; i < 40; ++i) {
        now_s += 0.25;  // 16 ticks
        clock.due(now_s);
        if (const auto dropped = clock.overrun_notice(now_s)) {
            noticed += *dropped;
            ++notices;
        }
    }
    EXPECT_LE(notices, 10);
    now_s += kOverrunNoticeEveryS;
    noticed += clock.overrun_notice(now_s).value_or(0);
    EXPECT_EQ(noticed, clock.dropped_ticks());
}

TEST(DurationHistogram, knows_quantiles_to_within_a_bucket) {
    DurationHistogram durations;
    for (int i = 1; i <= 1000; ++i) durations.record(1e-5 * i);
    EXPECT_NEAR(durations.quantile_s(0.5), 5e-3, 0.05 * 5e-3);
    EXPECT_NEAR(durations.quantile_s(0.99), 9.9e-3, 0.05 * 9.9e-3);
    EXPECT_DOUBLE_EQ(durations.quantile_s(1.0), durations.max_s());
    EXPECT_DOUBLE_EQ(durations.max_s(), 1e-2);
    EXPECT_NEAR(durations.mean_s(), 5.005e-3, 1e-12);
}

TEST(DurationHistogram, holds_any_duration) {
    DurationHistogram durations;
    EXPECT_EQ(durations.quantile_s(0.5), 0.0);
    EXPECT_EQ(durations.mean_s(), 0.0);
    durations.record(0.0);
    durations.record(1e9);
    EXPECT_EQ(durations.count(), 2U);
    EXPECT_EQ(durations.max_s(), 1e9);
    EXPECT_EQ(durations.quantile_s(1.0), 1e9);
}

}  // namespace
}  // namespace fts::server
