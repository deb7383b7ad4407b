// When inputs are sent: once a tick, and a little faster or slower to arrive just before it.
#include "client/core/input_pacer.h"

#include <gtest/gtest.h>

namespace fts::client {
namespace {

constexpr double kTickS = 1.0 / 60.0;

// A server that takes an input each tick, and a pacer that is looked at 1000 times a second.
struct Ticks {
    explicit Ticks(double wait_s) : wait_s_(wait_s) { pacer.start(0.0); }

    // Every input is reported `report_s` after it was sent.
    void run(double seconds, double report_s = 0.05) {
        for (const double end_s = now_s + seconds; now_s < end_s; now_s += 1e-3) {
            const int due = pacer.due(now_s, kTickS).inputs;
            for (int i = 0; i < due; ++i) sent_s.push_back(now_s);
            while (reported < sent_s.size() && sent_s[reported] + report_s <= now_s) {
                ++reported;
                pacer.observe(static_cast<std::uint32_t>(reported), slack_s(reported), now_s);
            }
        }
    }
    // Input n is taken at the end of tick n + k, for the k that is fitting at the start.
    double slack_s(std::size_t sequence) const {
        return wait_s_ + static_cast<double>(sequence - 1) * kTickS * (1.0 + server_slower) -
               sent_s[sequence - 1];
    }

    InputPacer pacer;
    double now_s = 0.0;
    double server_slower = 0.0;
    std::vector<double> sent_s;
    std::size_t reported = 0;

  private:
    double wait_s_ = 0.0;
};

TEST(InputPacer, sends_one_input_a_tick_until_it_is_told_otherwise) {
    Ticks ticks(0.1);
    ticks.run(10.0, 100.0);
    EXPECT_EQ(ticks.sent_s.size(), 600U);
    EXPECT_DOUBLE_EQ(ticks.pacer.pace(ticks.now_s), 1.0);
}

TEST(InputPacer, comes_to_the_slack_it_wants_from_either_side_and_stays) {
    for (const double wait_s : {0.0, 0.002, 0.03, 0.1}) {
        SCOPED_TRACE(wait_s);
        Ticks ticks(wait_s);
        ticks.run(4.0);
        for (int i = 0; i < 100; ++i) {
            ticks.run(0.1);
            ASSERT_NEAR(ticks.slack_s(ticks.sent_s.size()), InputPacer::kTargetSlackS, 0.002);
        }
    }
}

TEST(InputPacer, never_sends_faster_or_slower_than_its_limit) {
    for (const double wait_s : {-1.0, 1.0}) {
        Ticks ticks(wait_s);
        ticks.run(10.0);
        const double sent = static_cast<double>(ticks.sent_s.size());
        EXPECT_NEAR(sent / 600.0, 1.0, InputPacer::kMaxPaceChange + 0.002);
        EXPECT_GT(std::abs(sent / 600.0 - 1.0), InputPacer::kMaxPaceChange - 0.005);
    }
}

TEST(InputPacer, keeps_to_a_server_whose_clock_drifts) {
    for (const double slower : {-200e-6, 200e-6}) {
        SCOPED_TRACE(slower);
        Ticks ticks(0.01);
        ticks.server_slower = slower;
        ticks.run(300.0);
        EXPECT_NEAR(ticks.slack_s(ticks.sent_s.size()), InputPacer::kTargetSlackS, 0.002);
    }
}

TEST(InputPacer, goes_by_the_least_slack_of_late) {
    InputPacer pacer;
    pacer.start(0.0);
    for (double now_s = 0.0; now_s < 0.2; now_s += kTickS) pacer.due(now_s, kTickS);
    pacer.observe(1, 0.001, 1.0);
    EXPECT_GT(pacer.pace(1.0), 1.0);
    pacer.observe(2, 0.05, 1.1);
    EXPECT_GT(pacer.pace(1.1), 1.0);
    pacer.observe(3, 0.05, 1.1 + InputPacer::kWindowS);
    EXPECT_LT(pacer.pace(1.1 + InputPacer::kWindowS), 1.0);
    EXPECT_DOUBLE_EQ(pacer.pace(1.2 + 2 * InputPacer::kWindowS), 1.0) << "nothing heard of late";
}

TEST(InputPacer, passes_over_reports_of_what_was_never_sent_or_that_come_late) {
    InputPacer pacer;
    pacer.start(0.0);
    for (double now_s = 0.0; now_s < 0.2; now_s += kTickS) pacer.due(now_s, kTickS);
    pacer.observe(100, 1.0, 0.2);
    pacer.observe(0, 1.0, 0.2);
    EXPECT_DOUBLE_EQ(pacer.pace(0.2), 1.0);
    pacer.observe(5, InputPacer::kTargetSlackS, 0.2);
    pacer.observe(4, 0.0, 0.2);
    EXPECT_NEAR(pacer.pace(0.2), 1.0, 1e-9);
}

}  // namespace
}  // namespace fts::client
