// What comes from a client before it reaches the match: inputs in order, text that can be shown,
// rates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/input_queue.h"
#include "server/limits.h"
#include "server/plain_text.h"
#include "server/rate_limit.h"

namespace fts::server {
namespace {

using replication::InputPacket;

game::InputCommand push(int thrust_x) {
    return {static_cast<std::int8_t>(thrust_x), 0, false, false};
}

// Inputs `first` to `last`, each of which pushes with its own sequence.
InputPacket packet(std::uint32_t first, std::uint32_t last) {
    InputPacket result{0, first, {}};
    for (std::uint32_t i = first; i <= last; ++i) {
        result.inputs.push_back(push(static_cast<int>(i % 100)));
    }
    return result;
}

TEST(InputQueue, applies_each_input_once_and_in_order_although_packets_repeat_them) {
    InputQueue queue;
    for (std::uint32_t tick = 1; tick <= 50; ++tick) {
        const std::uint32_t oldest = tick > 10 ? tick - 10 : 1;
        ASSERT_TRUE(queue.add(packet(oldest, tick)));
        ASSERT_EQ(queue.next(), push(static_cast<int>(tick)));
        ASSERT_EQ(queue.applied_sequence(), tick);
    }
    EXPECT_EQ(queue.left_out(), 0U);
}

TEST(InputQueue, holds_the_last_input_through_a_gap_and_lets_go_in_a_long_silence) {
    InputQueue queue;
    queue.add(packet(1, 1));
    EXPECT_EQ(queue.next(), push(1));
    for (int i = 0; i < kInputSilenceTicks; ++i) EXPECT_EQ(queue.next(), push(1));
    EXPECT_EQ(queue.next(), game::InputCommand{});
    EXPECT_EQ(queue.applied_sequence(), 1U);
}

TEST(InputQueue, leaves_out_the_oldest_of_a_burst) {
    InputQueue queue;
    queue.add(packet(1, 20));
    EXPECT_EQ(queue.size(), kMaxQueuedInputs);
    EXPECT_EQ(queue.left_out(), 20 - kMaxQueuedInputs);
    EXPECT_EQ(queue.next(), push(static_cast<int>(20 - kMaxQueuedInputs + 1)));
}

TEST(InputQueue, shortens_a_delay_that_is_not_needed) {
    InputQueue queue;
    queue.add(packet(1, 6));
    std::uint32_t sequence = 6;
    for (int i = 0; i < 10 * kInputSlackWindowTicks; ++i) {
        ++sequence;
        queue.add(packet(sequence, sequence));
        queue.next();
    }
    EXPECT_LE(queue.size(), 1U);
}

TEST(InputQueue, says_how_long_inputs_waited_at_least) {
    InputQueue queue;
    EXPECT_EQ(queue.take_slack(), replication::kNoInputWaited);
    queue.add(packet(1, 2), 0.25);
    queue.next();
    EXPECT_EQ(queue.take_slack(), 4) << "a quarter of a tick";
    queue.add(packet(3, 3), 1.0);
    queue.next();
    queue.next();
    EXPECT_EQ(queue.take_slack(), 20) << "input 2 waited 1.25 ticks, input 3 two";
}

TEST(InputQueue, says_that_a_tick_found_no_input) {
    InputQueue queue;
    queue.add(packet(1, 1), 0.5);
    queue.next();
    queue.next();
    queue.add(packet(2, 2), 0.5);
    queue.next();
    EXPECT_EQ(queue.take_slack(), replication::kNoInputWaited);
    queue.add(packet(3, 3), 0.5);
    queue.next();
    EXPECT_EQ(queue.take_slack(), 8) << "it is said once";
}

TEST(InputQueue, ignores_old_packets_that_come_late) {
    InputQueue queue;
    queue.add(packet(10, 12));
    queue.add(packet(5, 9));
    EXPECT_EQ(queue.size(), 3U);
    EXPECT_EQ(queue.next(), push(10));
}

TEST(InputQueue, refuses_sequences_no_client_can_have_come_to) {
    InputQueue queue;
    EXPECT_FALSE(queue.add(packet(0, 3)));
    EXPECT_FALSE(queue.add(packet(kMaxInputLead + 1, kMaxInputLead + 1)));
    EXPECT_FALSE(queue.add(InputPacket{0, 0xffffffffU, {push(1), push(2)}}));
    EXPECT_EQ(queue.size(), 0U);
    EXPECT_TRUE(queue.add(InputPacket{7, 0, {}})) << "an acknowledgement alone is fine";
    EXPECT_TRUE(queue.add(packet(kMaxInputLead, kMaxInputLead)));
}

TEST(RateLimit, allows_a_burst_and_then_its_rate) {
    RateLimit limit(10.0, 5.0);
    int allowed = 0;
    for (int i = 0; i < 100; ++i) allowed += limit.allow(100.0) ? 1 : 0;
    EXPECT_EQ(allowed, 5);
    for (int i = 0; i < 1000; ++i) allowed += limit.allow(100.0 + 0.01 * i) ? 1 : 0;
    EXPECT_NEAR(allowed, 5 + 100, 1);
}

TEST(PlainLine, keeps_text_of_any_language) {
    EXPECT_EQ(plain_line("Zoë 東京 🎱", 100), "Zoë 東京 🎱");
}

TEST(PlainLine, leaves_out_control_characters_and_invisible_ones) {
    EXPECT_EQ(plain_line("a\x1b[0m\r\nb\x7f", 100), "a[0mb");
    EXPECT_EQ(plain_line("a\u202eb\u200bc\ufeffd\u0085", 100), "abcd");
}

TEST(PlainLine, leaves_out_what_is_not_utf8) {
    EXPECT_EQ(plain_line("a\xff\xc3z\xe2\x82!", 100), "az!");
    EXPECT_EQ(plain_line("\xc0\xaf/\xed\xa0\x80/\xf5\x80\x80\x80", 100), "//");
}

TEST(PlainLine, trims_and_cuts_between_characters) {
    EXPECT_EQ(plain_line("   two words   ", 100), "two words");
    EXPECT_EQ(plain_line("ééé", 5), "éé");
    EXPECT_EQ(plain_line(" \x01 ", 10), "");
}

}  // namespace
}  // namespace fts::server
