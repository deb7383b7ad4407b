// The worked examples of proto/WIRE.md, "Payloads", byte for byte.
#include <gtest/gtest.h>

#include "common/replication/control_events.h"
#include "common/replication/delta.h"
#include "common/replication/snapshot_codec.h"
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

const Bytes kDelta = {0x6a, 0x06, 0x02, 0x09, 0x17,                          // header
                      0xe7,                                                  // ball 1
                      0x05, 0x02, 0x02, 0x00, 0x7f, 0x00,                    // ball 2
                      0xc0,                                                  // ball 5
                      0xf0, 0x01, 0x22, 0x03, 0x40, 0x00, 0x80, 0x7f,        // ball 7
                      0x03, 0x80, 0x00, 0x00, 0x01,                          // its body
                      0xff,                                                  // no more balls
                      0xc0, 0xff,                                            // coin 4, no more
                      0x01, 0x01, 0x01, 0x02, 0xb2, 0x84, 0xfd, 0x80, 0x03,  // one hit
                      0x4e, 0xc7, 0x86, 0x54};                               // digest

TEST(WorkedExample, SnapshotPart) {
    const auto parts = encode_delta(tick_100(), tick_106(), 1100);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts.front(), kDelta);
    EXPECT_EQ(decode_part(tick_100(), kDelta), tick_106());
}

TEST(WorkedExample, SnapshotPacket) {
    Bytes expected = {0x02, 0xb0, 0x09, 0x14};
    expected.insert(expected.end(), kDelta.begin(), kDelta.end());
    EXPECT_EQ(
        encode(SnapshotPacket{.acked_input_sequence = 1200, .input_slack = 20, .part = kDelta}),
        expected);
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

Prediction three_balls() {
    Prediction expected{97, 100, {}};
    for (std::uint16_t i = 0; i < 3; ++i) {
        Expectation next;
        next.state = ball(static_cast<std::uint16_t>(i + 1), 1000 * (i + 1), 500, 40, 0);
        next.place_doubt = 4;
        next.group = i;
        expected.balls.push_back(next);
    }
    return expected;
}

std::vector<BallState> three_balls_at_100() {
    return {ball(1, 1001, 500, 40, 0), ball(2, 2000, 500, 40, 0), ball(3, 3000, 500, 37, 0)};
}

TEST(WorkedExample, OfAResidualPart) {
    const Bytes bytes{0x64, 0x03, 0x00, 0x04, 0x26, 0xe8, 0x79, 0x9d, 0x64, 0x91};
    const auto parts = encode_balls(three_balls(), three_balls_at_100(), 1200);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts.front(), bytes);
    EXPECT_EQ(decode_balls(three_balls(), bytes), three_balls_at_100());
}

TEST(WorkedExample, OfAControlPart) {
    const Bytes bytes{0x64, 0x03, 0xb8, 0x92, 0x2f, 0x43, 0x10};
    Snapshot baseline;
    baseline.tick = 97;
    baseline.balls = three_balls_at_100();
    baseline.balls[1].kind = static_cast<std::uint8_t>(BallKind::kPlayer);
    Snapshot outcome;
    outcome.tick = 100;
    outcome.balls = three_balls_at_100();
    const ArenaEvents events{{{98, 2, 127, 0, false}}, {}};
    EXPECT_EQ(encode_events(baseline, events, outcome), bytes);
    const auto part = decode_events(baseline, bytes);
    ASSERT_TRUE(part);
    EXPECT_EQ(part->events, events);
    EXPECT_EQ(part->outcome_digest, outcome_digest_of(outcome));
}

}  // namespace
}  // namespace fts::replication
