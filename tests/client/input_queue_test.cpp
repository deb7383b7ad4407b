// Inputs wait until the server has them.
#include "client/core/input_queue.h"

#include <gtest/gtest.h>

namespace fts::client {
namespace {

game::InputCommand thrust(int x) {
    return {static_cast<std::int8_t>(x), 0, false, false};
}

TEST(InputQueue, repeats_everything_that_is_not_acknowledged_oldest_first) {
    InputQueue queue;
    for (int i = 1; i <= 5; ++i) queue.push(thrust(i));
    queue.acknowledge(2);
    const auto packet = queue.packet(77);
    EXPECT_EQ(packet.acked_snapshot_tick, 77U);
    EXPECT_EQ(packet.first_sequence, 3U);
    ASSERT_EQ(packet.inputs.size(), 3U);
    EXPECT_EQ(packet.inputs.front(), thrust(3));
    EXPECT_EQ(packet.inputs.back(), thrust(5));
}

TEST(InputQueue, passes_over_acknowledgements_that_come_late) {
    InputQueue queue;
    for (int i = 1; i <= 5; ++i) queue.push(thrust(i));
    queue.acknowledge(4);
    queue.acknowledge(2);
    EXPECT_EQ(queue.packet(0).first_sequence, 5U);
}

TEST(InputQueue, believes_no_acknowledgement_of_what_was_never_sent) {
    InputQueue queue;
    for (int i = 1; i <= 5; ++i) queue.push(thrust(i));
    queue.acknowledge(6);
    queue.acknowledge(0xffffffffU);
    EXPECT_EQ(queue.waiting(), 5U);
    queue.acknowledge(5);
    EXPECT_EQ(queue.waiting(), 0U);
}

TEST(InputQueue, gives_the_oldest_up_when_a_packet_holds_no_more_and_counts_it) {
    InputQueue queue;
    const auto most = static_cast<int>(replication::kMaxInputsPerPacket);
    for (int i = 1; i <= most + 3; ++i) queue.push(thrust(i));
    EXPECT_EQ(queue.packet(0).inputs.size(), replication::kMaxInputsPerPacket);
    EXPECT_EQ(queue.packet(0).first_sequence, 4U);
    EXPECT_EQ(queue.given_up_count(), 3U);
}

}  // namespace
}  // namespace fts::client
