// How a client keeps time: the clock it draws by, and the delay that it draws behind.
#include "client/core/server_clock.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace fts::client {
namespace {

constexpr double kSnapshotS = 1.0 / 30.0;
constexpr double kFrameS = 1.0 / 144.0;

// Snapshots over a link with a random delay, frames in between.
struct JitteryRun {
    explicit JitteryRun(unsigned seed) : random(seed) {}

    double jitter_s(double most_s) { return std::uniform_real_distribution<>(0.0, most_s)(random); }

    // Runs to `end_s` of local time; `on_frame(now_s, draw_s)`. The server's clock is `ahead_s`
    // ahead.
    template <typename OnFrame>
    void run(double end_s, double most_jitter_s, double loss, OnFrame on_frame) {
        for (; now_s < end_s; now_s += kFrameS) {
            while (next_arrival_s <= now_s) {
                if (next_server_s > newest_server_s && jitter_s(1.0) >= loss) {
                    clock.observe(next_server_s, next_arrival_s);
                    newest_server_s = next_server_s;
                }
                next_server_s += kSnapshotS;
                const double flight_s = 0.02 + jitter_s(most_jitter_s);
                next_arrival_s = std::max(next_arrival_s, next_server_s - ahead_s + flight_s);
            }
            if (clock.started()) on_frame(now_s, clock.draw_time_s(now_s));
        }
    }

    std::mt19937 random;
    ServerClock clock;
    double ahead_s = 1000.0;
    double now_s = 0.0;
    double next_server_s = 1000.0;
    double newest_server_s = 0.0;
    double next_arrival_s = 0.02;
};

TEST(ServerClock, never_draws_an_earlier_moment_however_arrivals_jitter) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        JitteryRun run(seed);
        double last_s = -1.0;
        for (const double jitter_s : {0.0, 0.2, 0.01, 0.5, 0.05}) {
            run.run(run.now_s + 3.0, jitter_s, 0.1, [&](double, double draw_s) {
                ASSERT_GE(draw_s, last_s);
                last_s = draw_s;
            });
        }
    }
}

TEST(ServerClock, settles_one_snapshot_behind_on_a_steady_link) {
    JitteryRun run(1);
    double behind_s = 0.0;
    run.run(60.0, 0.0, 0.0, [&](double now_s, double draw_s) {
        behind_s = now_s + run.ahead_s - draw_s;  // against the server's own clock
    });
    EXPECT_NEAR(behind_s, 0.02 + kSnapshotS + kDelayMarginS, 0.002);
}

TEST(ServerClock, seldom_runs_dry_once_it_knows_the_jitter) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        JitteryRun run(seed);
        int frames = 0, starved = 0;
        run.run(5.0, 0.04, 0.0, [](double, double) {});
        run.run(65.0, 0.04, 0.0, [&](double, double draw_s) {
            ++frames;
            if (draw_s > run.newest_server_s) ++starved;
        });
        EXPECT_LT(starved, frames / 100);
    }
}

TEST(ServerClock, follows_a_server_that_falls_behind) {
    JitteryRun run(1);
    run.run(5.0, 0.01, 0.0, [](double, double) {});
    run.ahead_s -= 0.3;
    double behind_s = 0.0;
    run.run(20.0, 0.01, 0.0,
            [&](double now_s, double draw_s) { behind_s = now_s + run.ahead_s - draw_s; });
    EXPECT_LT(behind_s, 0.2);
    EXPECT_GT(behind_s, 0.0);
}

TEST(PacedClock, catches_up_faster_than_real_time_but_not_much) {
    PacedClock clock;
    clock.follow(0.0, 0.0);
    const double reading_s = clock.follow(1.2, 1.0);
    EXPECT_DOUBLE_EQ(reading_s, 1.0 + PacedClock::kMaxSpeedUp);
}

TEST(PacedClock, jumps_ahead_when_it_is_lost) {
    PacedClock clock;
    clock.follow(0.0, 0.0);
    EXPECT_DOUBLE_EQ(clock.follow(10.0, 0.1), 10.0);
}

TEST(PacedClock, stands_still_while_its_target_is_far_behind) {
    PacedClock clock;
    clock.follow(10.0, 0.0);
    EXPECT_DOUBLE_EQ(clock.follow(0.0, 0.1), 10.0);
}

TEST(InterpolationDelay, goes_up_at_once) {
    InterpolationDelay delay;
    delay.observe(kSnapshotS, 1.0);
    delay.observe(0.25, 1.1);
    EXPECT_DOUBLE_EQ(delay.delay_s(), 0.25 + kDelayMarginS);
}

TEST(InterpolationDelay, begins_with_what_the_first_arrival_needed) {
    InterpolationDelay delay;
    EXPECT_DOUBLE_EQ(delay.delay_s(), kInitialDelayS);
    delay.observe(kSnapshotS, 1.0);
    EXPECT_DOUBLE_EQ(delay.delay_s(), kSnapshotS + kDelayMarginS);
}

TEST(InterpolationDelay, comes_down_slowly_and_all_the_way) {
    InterpolationDelay delay;
    delay.observe(0.25, 0.0);
    double last_s = delay.delay_s();
    for (int i = 1; i <= 30; ++i) {
        delay.observe(kSnapshotS, i * kSnapshotS);
        EXPECT_LT(delay.delay_s(), last_s);
        last_s = delay.delay_s();
    }
    EXPECT_GT(last_s, 0.2);  // after one second
    for (int i = 31; i <= 1800; ++i) delay.observe(kSnapshotS, i * kSnapshotS);
    EXPECT_NEAR(delay.delay_s(), kSnapshotS + kDelayMarginS, 1e-4);
}

TEST(InterpolationDelay, has_a_limit_and_counts_what_exceeds_it) {
    InterpolationDelay delay;
    delay.observe(30.0, 0.0);
    EXPECT_DOUBLE_EQ(delay.delay_s(), kMaxDelayS);
    EXPECT_EQ(delay.limited_count(), 1U);
}

}  // namespace
}  // namespace fts::client
