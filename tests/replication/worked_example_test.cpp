// The worked examples of proto/WIRE.md, "Payloads", byte for byte.
#include <gtest/gtest.h>

#include "common/replication/delta.h"
#include "common/replication/wire.h"

namespace fts::replication {
namespace {

using Bytes = std::vector<std::uint8_t>;

BallState ball(std::uint16_t id, std::int32_t x, std::int32_t y, std::int32_t vx, std::int32_t vy) {
    BallState state;
    state.id = id;
    state.x = x;
    state.y = y;
    state.vx = vx;
    state.vy = vy;
    state.radius = 128;
    state.mass = 256;
    return state;
}

Snapshot tick_100() {
    Snapshot snapshot;
    snapshot.tick = 100;
    snapshot.phase = game::Phase::kPlaying;
    snapshot.level = 1;
    snapshot.phase_end_tick = 7200;
    snapshot.balls = {ball(1, 1024, 0, 256, 0), ball(2, -2048, 512, 0, 0),
                      ball(5, 0, -3072, 0, -128)};
    snapshot.balls[1].kind = static_cast<std::uint8_t>(BallKind::kPlayer);
    snapshot.balls[1].player_id = 3;
    snapshot.coins = {{.id = 4, .x = 500, .y = 500, .value_coins = 1}};
    return snapshot;
}

Snapshot tick_106() {
    Snapshot snapshot = tick_100();
    snapshot.tick = 106;
    snapshot.balls[0].x = 1127;
    snapshot.balls[1].x = -2022;
    snapshot.balls[1].vx = 128;
    snapshot.balls[1].thrust_x = 127;
    snapshot.balls[2] = ball(7, 2048, -1024, 0, 0);
    snapshot.coins.clear();
    snapshot.hits = {{.tick = 105, .a = 1, .b = 2, .x = 300, .y = -20, .impulse = 384}};
    return snapshot;
}

const Bytes kDelta = {0x6a, 0x06, 0x02, 0x1e, 0x26,                           // header
                      0xe7,                                                   // ball 1
                      0x05, 0x02, 0x02, 0x00, 0x7f, 0x00,                     // ball 2
                      0xc0,                                                   // ball 5
                      0xf0, 0x01, 0x22, 0x03, 0x40, 0x00, 0x80, 0x7f,         // ball 7
                      0x03, 0x80, 0x00, 0x00, 0x01,                           // its body
                      0xff,                                                   // no more balls
                      0xc0, 0xff,                                             // coin 4, no more
                      0x01, 0x01, 0x01, 0x02, 0xb2, 0x84, 0xfd, 0x80, 0x03};  // one hit

TEST(WorkedExample, SnapshotPart) {
    const auto parts = encode_delta(tick_100(), tick_106(), 1100);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts.front(), kDelta);
    EXPECT_EQ(decode_part(tick_100(), kDelta), tick_106());
}

TEST(WorkedExample, SnapshotPacket) {
    Bytes expected = {0x02, 0xb0, 0x09};
    expected.insert(expected.end(), kDelta.begin(), kDelta.end());
    EXPECT_EQ(encode(SnapshotPacket{.acked_input_sequence = 1200, .part = kDelta}), expected);
}

TEST(WorkedExample, InputPacket) {
    const InputPacket packet{.acked_snapshot_tick = 100,
                             .first_sequence = 1201,
                             .inputs = {{0, 0, false, false},
                                        {127, 0, false, false},
                                        {127, 0, false, false},
                                        {127, 0, true, true}}};
    const Bytes expected = {0x01, 0x64, 0xb1, 0x09, 0x00, 0x0c, 0x7f, 0x00, 0x03};
    EXPECT_EQ(encode(packet), expected);
    const auto back = decode_input_packet(expected);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->inputs, packet.inputs);
}

TEST(WorkedExample, ControlMessage) {
    const Bytes expected = {0x1a, 0x04, 0x0a, 0x02, 'g', 'g'};
    EXPECT_EQ(encode(ClientMessage(ChatRequest{"gg"})), expected);
}

}  // namespace
}  // namespace fts::replication
