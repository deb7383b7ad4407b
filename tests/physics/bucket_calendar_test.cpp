// The queue of bounded increment, against the heap that it must agree with to the last entry.
#include "common/physics/bucket_calendar.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/physics/dice.h"
#include "tests/physics/values.h"

namespace fts::physics {
namespace {

// Both calendars are told the same.
struct Both {
    explicit Both(std::uint32_t slots) : times_s(slots, kInfinite) {
        buckets.reset(slots);
        heap.reset(slots);
    }
    void set(std::uint32_t body, double time_s) {
        times_s[body] = time_s;
        buckets.set(body, time_s);
        heap.set(body, time_s);
    }
    void remove(std::uint32_t body) {
        times_s[body] = kInfinite;
        buckets.remove(body);
        heap.remove(body);
    }
    void rebase(double shift_s) {
        buckets.rebase(shift_s);
        for (std::uint32_t body = 0; body < times_s.size(); ++body) {
            times_s[body] -= shift_s;
            heap.set(body, times_s[body]);
        }
    }
    void expect_same_top() {
        ASSERT_EQ(buckets.empty(), heap.empty());
        ASSERT_EQ(buckets.top().time_s, heap.top().time_s);
        ASSERT_EQ(buckets.top().body, heap.top().body);
    }

    std::vector<double> times_s;
    BucketCalendar buckets;
    Calendar heap;
};

class BucketCalendarAgainstHeap : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, BucketCalendarAgainstHeap, testing::Range<std::uint64_t>(500, 508));

TEST_P(BucketCalendarAgainstHeap, as_a_gas_asks_what_is_due_and_sets_it_anew) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    for (const std::uint32_t slots : {1U, 3U, 63U, 64U, 700U}) {
        Both both(slots);
        for (std::uint32_t body = 0; body < slots; ++body) both.set(body, dice.between(0.0, 2.0));
        for (int turn = 0; turn < 20000; ++turn) {
            both.expect_same_top();
            if (HasFatalFailure()) return;
            const double now_s = both.heap.top().time_s;
            both.set(both.heap.top().body, now_s + dice.of_any_size(1e-3, 3.0));
            const auto other = static_cast<std::uint32_t>(dice.below(slots));
            if (turn % 2 == 0) both.set(other, now_s + dice.of_any_size(1e-3, 3.0));
            if (turn % 1000 == 999) both.rebase(now_s);
            // By this much, nothing is rounded.
            if (turn % 1000 == 499) both.rebase(std::exp2(std::floor(std::log2(now_s))));
        }
    }
}

TEST_P(BucketCalendarAgainstHeap, whatever_is_set_removed_and_rebased) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    const std::uint32_t slots = 150;
    Both both(slots);
    const auto some_time_s = [&] {
        switch (dice.below(8)) {
            case 0:
                return kInfinite;
            case 1:
                return static_cast<double>(dice.below(4));  // many at once
            case 2:
                return dice.of_any_size(1e-300, 1e300);
            case 3:
                return std::numeric_limits<double>::max();
            case 4:
                return -dice.of_any_size(1e-6, 1e6);  // before all others
            case 5:
                return std::numeric_limits<double>::denorm_min();
            default:
                return dice.between(0.0, 100.0);
        }
    };
    for (int turn = 0; turn < 20000; ++turn) {
        const auto body = static_cast<std::uint32_t>(dice.below(slots));
        const std::uint64_t what = dice.below(100);
        if (what == 0) both.rebase(dice.of_any_size(1e-3, 1e3));
        if (what < 30) {
            both.remove(both.heap.empty() || what < 5 ? body : both.heap.top().body);
        } else {
            both.set(body, some_time_s());
        }
        if (what % 2 == 0) both.expect_same_top();
        if (HasFatalFailure()) return;
    }
    while (!both.heap.empty()) {
        both.expect_same_top();
        if (HasFatalFailure()) return;
        both.remove(both.heap.top().body);
    }
    EXPECT_TRUE(both.buckets.empty());
}

// The pace becomes a million times faster, and slower, than the buckets were made for.
TEST_P(BucketCalendarAgainstHeap, when_the_pace_of_events_changes_between_rebases) {
    SCOPED_TRACE(GetParam());
    Dice dice(GetParam());
    const std::uint32_t slots = 200;
    for (const double pace : {1e-6, 1e6}) {
        Both both(slots);
        for (std::uint32_t body = 0; body < slots; ++body) both.set(body, dice.between(0.0, 1.0));
        for (int turn = 0; turn < 10000; ++turn) {
            both.expect_same_top();
            if (HasFatalFailure()) return;
            const double now_s = both.heap.top().time_s;
            both.set(both.heap.top().body, now_s + pace * dice.between(0.1, 1.0));
        }
    }
}

TEST(BucketCalendar, all_at_one_time_come_in_the_order_of_bodies) {
    BucketCalendar calendar;
    calendar.reset(1000);
    for (std::uint32_t body = 1000; body-- > 0;) calendar.set(body, 5.0);
    for (std::uint32_t body = 0; body < 1000; ++body) {
        ASSERT_EQ(calendar.top().body, body);
        calendar.set(body, body % 2 == 0 ? kInfinite : 7.0);
    }
    for (std::uint32_t body = 1; body < 1000; body += 2) {
        ASSERT_EQ(calendar.top().body, body);
        calendar.remove(body);
    }
    EXPECT_TRUE(calendar.empty());
    EXPECT_EQ(calendar.top().time_s, kInfinite);
}

}  // namespace
}  // namespace fts::physics
