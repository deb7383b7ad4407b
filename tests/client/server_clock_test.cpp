// How a client keeps time: the clock it draws by, and the delay that it draws behind.
#include "client/core/server_clock.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/client/watched_stream.h"

namespace fts::client {
namespace {

constexpr double kSnapshotS = 1.0 / 60.0;

net::LinkConditions jittery(double jitter_s, double loss, std::uint64_t seed) {
    return {.loss = loss, .delay_s = 0.03, .jitter_s = jitter_s, .seed = seed};
}

struct Seen {
    int frames = 0, starved = 0;
    double delay_sum_s = 0.0;
    Frame last;

    void add(const Frame& frame) {
        ++frames;
        if (frame.starved) ++starved;
        delay_sum_s += frame.delay_s;
        last = frame;
    }
    double starved_share() const { return double(starved) / frames; }
    double mean_delay_s() const { return delay_sum_s / frames; }
};

Seen watch(WatchedStream& stream, double seconds) {
    Seen seen;
    stream.run(seconds, [&](const Frame& frame) { seen.add(frame); });
    return seen;
}

// ---- the target

struct Study {
    double snapshot_hz = 0.0, frame_hz = 0.0, most_delay_s = 0.0, most_starved = 0.0;
};

class ClientTime : public testing::TestWithParam<Study> {};

// 10 minutes each, from the first 30 seconds on: 5 % loss, flights of 15 to 55 ms, every one of
// them equally likely, whatever the one before was.
TEST_P(ClientTime, starves_seldom_behind_a_short_delay_at_5_percent_loss_and_20_ms_jitter) {
    constexpr std::uint64_t kSeeds = 4;
    const Study& study = GetParam();
    Seen all;
    double worst_share = 0.0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const net::LinkConditions link{
            .loss = 0.05, .delay_s = 0.035, .jitter_s = 0.02, .seed = seed};
        WatchedStream stream({link, study.snapshot_hz, study.frame_hz});
        stream.run(30.0);
        const Seen seen = watch(stream, 600.0);
        EXPECT_EQ(stream.clock.step_count(), 0U);
        worst_share = std::max(worst_share, seen.starved_share());
        all.frames += seen.frames;
        all.starved += seen.starved;
        all.delay_sum_s += seen.delay_sum_s;
    }
    std::printf(
        "%.0f Hz drawn at %6.2f Hz, %d x 10 min: delay %5.1f ms, starved %.3f %% (worst "
        "run %.3f %%)\n",
        study.snapshot_hz, study.frame_hz, int(kSeeds), all.mean_delay_s() * 1e3,
        all.starved_share() * 1e2, worst_share * 1e2);
    EXPECT_LE(all.mean_delay_s(), study.most_delay_s);
    EXPECT_LT(all.starved_share(), study.most_starved);
}

INSTANTIATE_TEST_SUITE_P(Rates, ClientTime,
                         testing::Values(Study{60.0, 144.0, 0.050, 0.001},
                                         Study{60.0, 59.94, 0.050, 0.001},
                                         Study{30.0, 144.0, 0.090, 0.002},
                                         Study{20.0, 144.0, 0.125, 0.002}),
                         [](const auto& study) {
                             return std::to_string(int(study.param.snapshot_hz)) + "_hz_drawn_at_" +
                                    std::to_string(std::lround(study.param.frame_hz)) + "_hz";
                         });

// ---- pace

TEST(ServerClock, draws_ever_later_moments_at_nearly_the_pace_of_time_however_arrivals_jitter) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        WatchedStream stream({.link = jittery(0.03, 0.1, seed)});
        Frame last;
        std::uint64_t steps = 0;
        for (const double late_s : {0.0, 0.2, 0.01, 0.5, 0.05}) {
            stream.late_s = late_s;
            stream.run(4.0, [&](const Frame& frame) {
                const double moved_s = frame.draw_s - last.draw_s;
                const double passed_s = frame.now_s - last.now_s;
                ASSERT_GE(moved_s, 0.0);
                if (stream.clock.step_count() == steps && last.now_s > 0.0) {
                    ASSERT_LE(moved_s, passed_s * (1.0 + PacedClock::kMaxPaceChange) + 1e-9);
                }
                if (!last.starved) {
                    ASSERT_GE(moved_s, passed_s * (1.0 - PacedClock::kMaxPaceChange) - 1e-9);
                }
                steps = stream.clock.step_count();
                last = frame;
            });
        }
    }
}

TEST(ServerClock, estimates_ever_later_times_and_close_to_the_truth) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        WatchedStream stream({.link = jittery(0.02, 0.05, seed)});
        stream.run(3.0);
        double last_s = 0.0;
        stream.run(60.0, [&](const Frame& frame) {
            const double estimate_s = stream.clock.estimate_s(frame.now_s);
            ASSERT_GT(estimate_s, last_s);
            ASSERT_NEAR(estimate_s, frame.draw_s + frame.delay_s, 0.01);
            ASSERT_NEAR(stream.clock.delay_s(frame.now_s), frame.delay_s, 0.01);
            last_s = estimate_s;
        });
    }
}

TEST(PacedClock, catches_up_faster_than_real_time_but_not_much) {
    PacedClock clock;
    clock.follow(0.0, 0.0);
    EXPECT_DOUBLE_EQ(clock.follow(1.2, 1.0), 1.0 + PacedClock::kMaxPaceChange);
    EXPECT_EQ(clock.jump_count(), 0U);
}

TEST(PacedClock, jumps_ahead_when_it_is_lost_and_counts_that) {
    PacedClock clock;
    clock.follow(0.0, 0.0);
    EXPECT_DOUBLE_EQ(clock.follow(10.0, 0.1), 10.0);
    EXPECT_EQ(clock.jump_count(), 1U);
}

TEST(PacedClock, lets_its_target_catch_up_as_fast_as_it_may) {
    PacedClock clock;
    clock.follow(10.0, 0.0);
    EXPECT_DOUBLE_EQ(clock.follow(0.0, 1.0), 11.0 - PacedClock::kMaxPaceChange);
    EXPECT_DOUBLE_EQ(clock.follow(0.0, 2.0, 1.0), 11.0 - PacedClock::kMaxPaceChange);
}

// ---- what changes under way

TEST(ServerClock, settles_one_snapshot_behind_on_a_steady_link) {
    WatchedStream stream({.link = jittery(0.0, 0.0, 1)});
    stream.run(10.0);
    const Seen seen = watch(stream, 60.0);
    EXPECT_NEAR(seen.mean_delay_s(), kSnapshotS, 0.004);
    EXPECT_LE(seen.starved_share(), kDelayStarvedShare);
}

TEST(ServerClock, is_behind_enough_at_once_when_flights_become_longer_and_steps_nowhere) {
    for (const double longer_s : {0.03, 0.1, 0.2}) {
        SCOPED_TRACE(longer_s);
        WatchedStream stream({.link = jittery(0.005, 0.02, 1)});
        const Seen before = watch(stream, 40.0);
        stream.late_s += longer_s;
        stream.run(1.0);
        const Seen after = watch(stream, 20.0);
        EXPECT_LT(after.starved_share(), 0.01);
        EXPECT_NEAR(after.mean_delay_s(), before.mean_delay_s(), 0.02);
        EXPECT_EQ(stream.clock.step_count(), 0U);
    }
}

TEST(ServerClock, comes_closer_again_slowly_when_flights_become_shorter) {
    WatchedStream stream({.link = jittery(0.005, 0.02, 1)});
    stream.late_s = 0.1;
    const Seen before = watch(stream, 40.0);
    stream.late_s = 0.0;
    const Seen soon = watch(stream, 5.0);
    EXPECT_EQ(soon.starved, 0);
    EXPECT_GT(soon.last.delay_s, before.last.delay_s + 0.09);
    stream.run(kDelayWindowS);
    EXPECT_NEAR(watch(stream, 20.0).mean_delay_s(), before.mean_delay_s(), 0.01);
    EXPECT_EQ(stream.clock.step_count(), 0U);
}

TEST(ServerClock, keeps_time_with_a_server_whose_clock_drifts) {
    for (const double drift : {-200e-6, 200e-6}) {
        SCOPED_TRACE(drift);
        WatchedStream stream({.link = jittery(0.02, 0.05, 3), .server_drift = drift});
        stream.run(30.0);
        const Seen seen = watch(stream, 600.0);  // in which the clocks come 120 ms apart
        EXPECT_LT(seen.starved_share(), 0.002);
        EXPECT_LT(seen.mean_delay_s(), 0.055);
        EXPECT_NEAR(stream.clock.delay_s(seen.last.now_s), seen.last.delay_s, 0.01);
        EXPECT_EQ(stream.clock.step_count(), 0U);
    }
}

TEST(ServerClock, steps_ahead_once_after_a_stall_and_does_not_pay_for_it_any_longer) {
    WatchedStream stream({.link = jittery(0.02, 0.05, 4)});
    stream.run(30.0);
    const Seen before = watch(stream, 30.0);
    stream.is_cut = true;
    const Seen stalled = watch(stream, 2.0);
    EXPECT_TRUE(stalled.last.starved);
    EXPECT_EQ(stream.clock.step_count(), 0U) << "there is nothing to step to";
    stream.is_cut = false;
    stream.run(1.0);
    EXPECT_EQ(stream.clock.step_count(), 1U);
    EXPECT_EQ(stream.clock.delay_limited_count(), 1U);
    const Seen after = watch(stream, 20.0);
    EXPECT_NEAR(after.mean_delay_s(), before.mean_delay_s(), 0.01);
    EXPECT_LT(after.starved_share(), 0.005);
}

TEST(ServerClock, does_not_pay_for_one_hiccup) {
    WatchedStream stream({.link = jittery(0.01, 0.0, 5)});
    stream.run(40.0);
    const Seen before = watch(stream, 10.0);
    stream.is_cut = true;
    stream.run(0.2);
    stream.is_cut = false;
    stream.run(1.0);
    EXPECT_NEAR(watch(stream, 10.0).mean_delay_s(), before.mean_delay_s(), 0.005);
}

TEST(ServerClock, follows_a_server_that_drops_time) {
    WatchedStream stream({.link = jittery(0.01, 0.02, 1)});
    stream.run(20.0);
    stream.server_behind_s = 1.9;
    stream.run(6.0);
    const Seen seen = watch(stream, 10.0);
    EXPECT_LT(seen.mean_delay_s(), 0.1);
    EXPECT_LT(seen.starved_share(), 0.01);
}

// ---- the delay

// A newer snapshot every interval, each time at the age given.
double at_60_hz(InterpolationDelay& delay, double age_s, double begin_s, double end_s) {
    for (double now_s = begin_s; now_s < end_s; now_s += kSnapshotS) {
        delay.observe(age_s, 0.0, now_s);
    }
    return delay.age_to_draw_s();
}

TEST(InterpolationDelay, begins_with_what_the_first_arrival_needed) {
    InterpolationDelay delay;
    EXPECT_FALSE(delay.measured());
    delay.observe(kSnapshotS, 0.0, 1.0);
    EXPECT_TRUE(delay.measured());
    EXPECT_DOUBLE_EQ(delay.age_to_draw_s(), kSnapshotS + kDelayMarginS);
}

TEST(InterpolationDelay, goes_up_at_once) {
    InterpolationDelay delay;
    EXPECT_NEAR(at_60_hz(delay, kSnapshotS, 0.0, 10.0), kSnapshotS, 1e-3);
    delay.observe(0.2, 0.0, 10.0);
    EXPECT_NEAR(delay.age_to_draw_s(), 0.2, kDelayStarvedShare * kDelayWindowS);
}

TEST(InterpolationDelay, passes_over_the_worst_of_a_full_window_but_not_over_the_next) {
    InterpolationDelay delay;
    at_60_hz(delay, kSnapshotS, 0.0, kDelayWindowS + 1.0);
    delay.observe(0.2, 0.0, kDelayWindowS + 1.0);
    EXPECT_NEAR(delay.age_to_draw_s(), kSnapshotS, 1e-3);
    delay.observe(0.15, 0.0, kDelayWindowS + 2.0);
    EXPECT_NEAR(delay.age_to_draw_s(), 0.15, kDelayStarvedShare * kDelayWindowS);
}

TEST(InterpolationDelay, comes_down_when_what_it_paid_for_is_long_past) {
    InterpolationDelay delay;
    at_60_hz(delay, 0.2, 0.0, 1.0);
    EXPECT_NEAR(at_60_hz(delay, kSnapshotS, 1.0, kDelayWindowS), 0.2, 1e-3);
    EXPECT_NEAR(at_60_hz(delay, kSnapshotS, kDelayWindowS, kDelayWindowS + 2.0), kSnapshotS, 1e-3);
}

TEST(InterpolationDelay, leaves_the_share_of_time_it_is_allowed_without_a_newer_snapshot) {
    std::uint64_t state = 7;  // ages of 20 to 60 ms, evenly
    const auto next_age_s = [&] {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        return 0.02 + 0.04 * static_cast<double>(state >> 11) * 0x1p-53;
    };
    InterpolationDelay delay;
    std::vector<double> ages_s;
    for (double now_s = 0.0; now_s < 20.0; now_s += kSnapshotS) {
        ages_s.push_back(next_age_s());
        delay.observe(ages_s.back(), 0.0, now_s);
    }
    delay.observe(0.0, 0.0, 20.0 + InterpolationDelay::kReviewS);
    const double drawn_s = delay.age_to_draw_s() - kDelayMarginS;
    double without_s = 0.0;
    for (const double age_s : ages_s) without_s += std::max(0.0, age_s - drawn_s);
    EXPECT_NEAR(without_s / 20.0, kDelayStarvedShare, 0.05 * kDelayStarvedShare);
}

TEST(InterpolationDelay, has_a_limit_and_counts_what_exceeds_it) {
    InterpolationDelay delay;
    delay.observe(30.0, 1.0, 0.0);
    EXPECT_DOUBLE_EQ(delay.age_to_draw_s(), 1.0 + kMaxDelayS + kDelayMarginS)
        << "beyond the usual flight";
    EXPECT_EQ(delay.limited_count(), 1U);
    delay.observe(1.02, 1.0, 0.1);
    delay.observe(1.5, 1.0, 0.2);
    EXPECT_EQ(delay.limited_count(), 2U);
}

}  // namespace
}  // namespace fts::client
