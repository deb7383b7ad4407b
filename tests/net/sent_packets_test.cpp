#include "common/net/sent_packets.h"

#include <gtest/gtest.h>

namespace fts::net {
namespace {

using Fragments = std::vector<std::uint64_t>;

TEST(SentPackets, the_time_that_an_acknowledgement_waited_is_not_part_of_the_round_trip) {
    SentPackets sent;
    Fragments fragments;
    for (std::uint64_t number = 1; number <= 50; ++number) {
        const double now_s = 0.2 * static_cast<double>(number);
        sent.record(now_s, {});
        ASSERT_TRUE(sent.acknowledge({number, 0, 0.06}, now_s + 0.1, fragments));
    }
    EXPECT_NEAR(sent.rtt_s(), 0.04, 1e-9);
    EXPECT_LT(sent.rtt_jitter_s(), 1e-3);
}

TEST(SentPackets, a_wait_that_is_a_lie_does_not_make_time_run_backwards) {
    SentPackets sent;
    Fragments fragments;
    sent.record(1.0, {});
    ASSERT_TRUE(sent.acknowledge({1, 0, 6.5}, 1.1, fragments));
    EXPECT_GE(sent.rtt_s(), 0.0);
    EXPECT_GT(sent.resend_after_s(), 0.0);
}

TEST(SentPackets, each_packets_fragments_are_reported_once_however_often_it_is_acknowledged) {
    SentPackets sent;
    sent.record(0.0, {7, 8});
    sent.record(0.0, {9});
    sent.record(0.0, {10});
    Fragments fragments;
    ASSERT_TRUE(sent.acknowledge({3, 0b10, 0.0}, 0.1, fragments));
    EXPECT_EQ(fragments, (Fragments{10, 7, 8}));
    ASSERT_TRUE(sent.acknowledge({3, 0b11, 0.0}, 0.1, fragments));
    EXPECT_EQ(fragments, (Fragments{10, 7, 8, 9}));
    ASSERT_TRUE(sent.acknowledge({2, 0b1, 0.0}, 0.1, fragments));
    EXPECT_EQ(fragments.size(), 4U);
}

TEST(SentPackets, what_a_silent_link_swallows_is_forgotten_as_lost_and_not_kept) {
    SentPackets sent;
    for (std::size_t i = 0; i < 2 * kMaxUnresolvedPackets; ++i) sent.record(0.0, {});
    const std::uint64_t next = sent.next_number();
    sent.update(0.0);
    EXPECT_GT(sent.loss(), 0.9);
    sent.update(100.0);
    EXPECT_EQ(sent.next_number(), next) << "numbers go on, whatever is forgotten";
    Fragments fragments;
    EXPECT_TRUE(sent.acknowledge({next - 1, 0, 0.0}, 100.0, fragments)) << "late, not wrong";
}

}  // namespace
}  // namespace fts::net
