#include "common/net/sequence.h"

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fts::net {
namespace {

TEST(Sequence, a_number_is_recovered_from_its_low_half_when_it_is_near_the_reference) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 100000; ++i) {
        const std::uint64_t reference = random() >> (random() % 64);
        const auto distance = static_cast<std::int64_t>(random() % 0x7fffffffU) - 0x3fffffff;
        if (distance < 0 && reference < static_cast<std::uint64_t>(-distance)) continue;
        const std::uint64_t number = reference + static_cast<std::uint64_t>(distance);
        if (distance > 0 && number < reference) continue;
        ASSERT_EQ(nearest_with_low_bits(static_cast<std::uint32_t>(number), reference), number)
            << "reference " << reference << " distance " << distance;
    }
}

TEST(Sequence, recovers_across_the_wrap_of_the_low_half) {
    constexpr std::uint64_t kPeriod = std::uint64_t{1} << 32;
    EXPECT_EQ(nearest_with_low_bits(0xffffffff, kPeriod), kPeriod - 1);
    EXPECT_EQ(nearest_with_low_bits(0, kPeriod - 1), kPeriod);
    EXPECT_EQ(nearest_with_low_bits(5, 7 * kPeriod - 5), 7 * kPeriod + 5);
    EXPECT_EQ(nearest_with_low_bits(0xfffffff0, 3), 0xfffffff0) << "there is nothing below zero";
}

TEST(ReplayWindow, takes_each_number_at_most_once_in_whatever_order_they_come) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        ReplayWindow window;
        std::set<std::uint64_t> taken;
        std::uint64_t newest = 0;
        for (int i = 0; i < 5000; ++i) {
            const std::uint64_t jump = random() % 200 == 0 ? 3000 : 0;
            const std::uint64_t number = 1 + static_cast<std::uint64_t>(i) + random() % 900 + jump;
            const bool too_old = newest >= number + kReplayWindowPackets;
            ASSERT_EQ(window.is_fresh(number), !too_old && !taken.contains(number)) << number;
            if (!window.is_fresh(number)) continue;
            window.mark(number);
            taken.insert(number);
            newest = std::max(newest, number);
            ASSERT_EQ(window.newest(), newest);
            for (std::uint64_t back = 0; back < kAckBits && back + 1 < newest; ++back) {
                ASSERT_EQ((window.seen_before_newest() >> back) & 1,
                          taken.contains(newest - 1 - back) ? 1U : 0U);
            }
        }
    }
}

TEST(ReplayWindow, nothing_before_the_first_packet_counts_as_seen) {
    ReplayWindow window;
    EXPECT_FALSE(window.is_fresh(0)) << "0 means none";
    EXPECT_EQ(window.newest(), 0U);
    EXPECT_EQ(window.seen_before_newest(), 0U);
    window.mark(1);
    EXPECT_EQ(window.seen_before_newest(), 0U);
}

TEST(ReplayWindow, a_jump_of_any_size_leaves_no_trace_of_older_numbers) {
    ReplayWindow window;
    for (std::uint64_t number = 1; number <= 100; ++number) window.mark(number);
    window.mark(std::uint64_t{1} << 60);
    EXPECT_EQ(window.seen_before_newest(), 0U);
    EXPECT_TRUE(window.is_fresh((std::uint64_t{1} << 60) - 1));
    EXPECT_FALSE(window.is_fresh(100));
}

}  // namespace
}  // namespace fts::net
