#include "common/physics/calendar.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/physics/dice.h"
#include "tests/physics/values.h"

namespace fts::physics {
namespace {

TEST(Calendar, equal_times_come_in_the_order_of_bodies) {
    Calendar calendar;
    calendar.reset(9);
    for (const std::uint32_t body : {7U, 2U, 8U, 0U, 5U}) calendar.set(body, 1.0);
    calendar.set(6, 0.5);
    for (const std::uint32_t body : {6U, 0U, 2U, 5U, 7U, 8U}) {
        ASSERT_EQ(calendar.top().body, body);
        calendar.remove(body);
    }
    EXPECT_TRUE(calendar.empty());
    EXPECT_EQ(calendar.top().time_s, kInfinite);
}

// Against a plain table that is searched through.
TEST(Calendar, has_the_earliest_on_top_whatever_is_set_and_removed) {
    constexpr std::uint64_t kSeed = 71;
    SCOPED_TRACE(kSeed);
    Dice dice(kSeed);
    for (const std::uint32_t slots : {1U, 2U, 5U, 6U, 37U, 200U}) {
        Calendar calendar;
        calendar.reset(slots);
        std::vector<double> table(slots, kInfinite);
        for (int turn = 0; turn < 5000; ++turn) {
            const auto body = static_cast<std::uint32_t>(dice.below(slots));
            const std::uint64_t what = dice.below(10);
            if (what == 0) {
                table[body] = kInfinite;
                calendar.remove(body);
            } else {
                table[body] = static_cast<double>(dice.below(64));
                calendar.set(body, table[body]);
            }
            const auto first = std::min_element(table.begin(), table.end());
            ASSERT_EQ(calendar.top().time_s, *first);
            ASSERT_EQ(calendar.empty(), *first == kInfinite);
            if (calendar.empty()) continue;
            ASSERT_EQ(calendar.top().body, first - table.begin());
        }
    }
}

}  // namespace
}  // namespace fts::physics
