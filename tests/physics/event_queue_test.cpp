// Events come in the order of a sorted list, whenever they are pushed.
#include "common/physics/event_queue.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "tests/physics/dice.h"

namespace fts::physics {
namespace {

using Foreseen = Event<double>;

auto all_of(const Foreseen& event) {
    return std::tie(event.time_s, event.kind, event.a, event.b, event.count_a, event.count_b);
}

Foreseen event_at(double time_s, Dice& dice) {
    const auto below = [&](std::uint64_t limit) {
        return static_cast<std::uint32_t>(dice.below(limit));
    };
    Foreseen event;
    event.time_s = time_s;
    event.kind = static_cast<EventKind>(below(3));
    event.a = below(1000);
    event.b = below(1000);
    return event;
}

// The queue, and what it must be like: always the earliest of all that are in it.
class QueueAndList {
  public:
    void begin(double from_s, double until_s) {
        queue_.begin(from_s, until_s);
        list_.clear();
    }
    void push(Foreseen event) {
        event.count_a = pushed_++;
        // Equals but for the counts may come in either order: there shall be none.
        for (const Foreseen& other : list_) {
            if (!(event > other) && !(other > event)) return;
        }
        queue_.push(event);
        list_.push_back(event);
    }
    bool is_empty() {
        EXPECT_EQ(queue_.empty(), list_.empty());
        return list_.empty();
    }
    Foreseen pop() {
        const auto first = std::min_element(
            list_.begin(), list_.end(),
            [](const Foreseen& one, const Foreseen& other) { return other > one; });
        const Foreseen expected = *first, next = queue_.next(), seen = queue_.pop();
        EXPECT_EQ(all_of(next), all_of(expected));
        EXPECT_EQ(all_of(seen), all_of(expected));
        list_.erase(first);
        return expected;
    }
    EventQueue<Foreseen>& queue() { return queue_; }
    const std::vector<Foreseen>& list() const { return list_; }

  private:
    EventQueue<Foreseen> queue_;
    std::vector<Foreseen> list_;
    std::uint32_t pushed_ = 0;
};

TEST(EventQueue, random_events_pushed_before_and_during_taking_come_in_order_in_span_after_span) {
    constexpr std::uint64_t kSeed = 541;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    QueueAndList both;
    double from_s = -3.0;
    for (int span = 0; span < 200; ++span) {
        const double span_s = dice.of_any_size(1e-6, 1e3);
        both.begin(from_s, from_s + span_s);
        const auto some_time_s = [&](double now_s) {
            switch (dice.below(8)) {
                case 0:
                    return now_s;
                case 1:
                    return now_s - dice.between(0.0, 0.1) * span_s;
                case 2:
                    return from_s + dice.between(0.9, 1.2) * span_s;
                case 3:
                    return from_s + 0.125 * span_s * static_cast<double>(dice.below(9));
                default:
                    return dice.between(now_s, from_s + span_s);
            }
        };
        for (std::uint64_t i = dice.below(400); i > 0; --i) {
            both.push(event_at(some_time_s(from_s), dice));
        }
        std::uint64_t more = dice.below(400);
        while (!both.is_empty()) {
            const double now_s = both.pop().time_s;
            for (std::uint64_t i = dice.below(4); i > 0 && more > 0; --i, --more) {
                both.push(event_at(some_time_s(now_s), dice));
            }
            // A span may end before all of it was taken.
            if (span % 3 == 0 && more == 0) break;
        }
        if (HasFailure()) return;
        from_s += span_s;
    }
}

TEST(EventQueue, what_is_pushed_when_all_was_taken_comes_too) {
    Dice dice(542);
    QueueAndList both;
    both.begin(0.0, 1.0);
    EXPECT_TRUE(both.is_empty());
    for (const double time_s : {0.5, 0.2, 0.9, 0.9, 0.1, 3.0, -1.0}) {
        both.push(event_at(time_s, dice));
        ASSERT_FALSE(both.is_empty());
        both.pop();
        EXPECT_TRUE(both.is_empty());
    }
}

TEST(EventQueue, thousands_at_one_time_come_by_kind_and_then_by_bodies) {
    Dice dice(543);
    for (const double span_s : {1.0, 0.0}) {
        SCOPED_TRACE(span_s);
        QueueAndList both;
        for (int span = 0; span < 2; ++span) {
            both.begin(5.0, 5.0 + span_s);
            for (int i = 0; i < 2000; ++i) both.push(event_at(5.0 + 0.5 * span_s, dice));
            std::size_t taken = 0;
            while (!both.is_empty()) {
                both.pop();
                if (++taken <= 1000) both.push(event_at(5.0 + 0.5 * span_s, dice));
            }
            EXPECT_GT(taken, 2900U);
            if (HasFailure()) return;
        }
    }
}

TEST(EventQueue, in_a_span_of_no_length_times_are_still_in_order) {
    constexpr std::uint64_t kSeed = 544;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    QueueAndList both;
    for (int span = 0; span < 3; ++span) {
        both.begin(2.0, 2.0);
        for (int i = 0; i < 100; ++i) both.push(event_at(dice.between(1.0, 3.0), dice));
        for (int taken = 0; !both.is_empty(); ++taken) {
            both.pop();
            if (taken < 50) both.push(event_at(dice.between(1.0, 3.0), dice));
        }
    }
}

TEST(EventQueue, slices_to_come_show_just_what_is_in_the_queue_and_not_in_the_present_one) {
    constexpr std::uint64_t kSeed = 545;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    QueueAndList both;
    for (int span = 0; span < 3; ++span) {
        both.begin(0.0, 1.0);
        for (int i = 0; i < 300; ++i) both.push(event_at(dice.between(0.0, 1.0), dice));
        std::uint32_t last_slice = 0;
        while (!both.is_empty()) {
            std::vector<Foreseen> shown;
            for (std::uint32_t slice = both.queue().slice() + 1; slice < 1000; ++slice) {
                both.queue().for_each_in(slice,
                                         [&](const Foreseen& event) { shown.push_back(event); });
            }
            EXPECT_LE(last_slice, both.queue().slice());
            last_slice = both.queue().slice();
            EXPECT_LT(shown.size(), both.list().size());
            for (const Foreseen& event : shown) {
                EXPECT_TRUE(std::any_of(
                    both.list().begin(), both.list().end(),
                    [&](const Foreseen& other) { return all_of(other) == all_of(event); }));
            }
            const double now_s = both.pop().time_s;
            if (dice.below(3) == 0) both.push(event_at(dice.between(now_s, 1.0), dice));
            if (HasFailure()) return;
        }
        EXPECT_GE(last_slice, span > 0 ? 10U : 0U);
    }
}

}  // namespace
}  // namespace fts::physics
