#include <limits>

#include <gtest/gtest.h>

#include "common/replication/byte_stream.h"
#include "common/replication/control_events.h"
#include "common/replication/delta.h"
#include "common/replication/wire.h"
#include "tests/replication/random_snapshots.h"

namespace fts::replication {
namespace {

using testing::chance;
using testing::pick;
using testing::Rng;
using Bytes = std::vector<std::uint8_t>;

TEST(Varint, EveryValueHasOneFormAndComesBack) {
    for (const std::uint32_t value : {0U, 1U, 127U, 128U, 16'383U, 16'384U, 0xFFFFFFFFU}) {
        ByteWriter out;
        out.varint(value);
        EXPECT_LE(out.size(), kMaxVarintBytes);
        ByteReader in(out.bytes());
        EXPECT_EQ(in.varint(), value);
        EXPECT_TRUE(in.complete());
    }
    for (const Bytes& bytes :
         {Bytes{}, Bytes{0x80}, Bytes{0x80, 0x00}, Bytes{0xFF, 0x80, 0x00},
          Bytes{0xFF, 0xFF, 0xFF, 0xFF, 0x10}, Bytes{0x80, 0x80, 0x80, 0x80, 0x80, 0x01}}) {
        ByteReader in(bytes);
        EXPECT_EQ(in.varint(), 0U);
        EXPECT_TRUE(in.failed());
    }
}

game::InputCommand any_input(Rng& rng) {
    return {static_cast<std::int8_t>(pick(rng, -128, 127)),
            static_cast<std::int8_t>(pick(rng, -128, 127)), chance(rng, 50), chance(rng, 50)};
}

InputPacket any_packet(Rng& rng) {
    InputPacket packet;
    packet.acked_snapshot_tick = static_cast<Tick>(rng());
    packet.first_sequence = static_cast<std::uint32_t>(pick(rng, 0, 0xFFFFFF00));
    const auto count = static_cast<std::size_t>(pick(rng, 0, kMaxInputsPerPacket));
    while (packet.inputs.size() < count) {
        const bool held = !packet.inputs.empty() && chance(rng, 50);
        packet.inputs.push_back(held ? game::InputCommand(packet.inputs.back()) : any_input(rng));
    }
    return packet;
}

void expect_same(const InputPacket& a, const InputPacket& b) {
    EXPECT_EQ(a.acked_snapshot_tick, b.acked_snapshot_tick);
    EXPECT_EQ(a.first_sequence, b.first_sequence);
    EXPECT_EQ(a.inputs, b.inputs);
}

TEST(InputPacket, ComesBackWhateverTheInputs) {
    for (std::uint64_t seed = 1; seed <= 500; ++seed) {
        SCOPED_TRACE(seed);
        Rng rng(seed);
        const InputPacket packet = any_packet(rng);
        const Bytes bytes = encode(packet);
        EXPECT_LE(bytes.size(), kMaxInputPacketBytes);
        const auto back = decode_input_packet(bytes);
        ASSERT_TRUE(back);
        expect_same(*back, packet);
    }
}

TEST(InputPacket, InputHeldForThirtyTwoTicksIsThreeBytes) {
    InputPacket packet{.acked_snapshot_tick = 1, .first_sequence = 1, .inputs = {}};
    const std::size_t without_inputs = encode(packet).size();
    packet.inputs.assign(kMaxInputsPerPacket, {100, -50, false, true});
    EXPECT_EQ(encode(packet).size(), without_inputs + 3);
}

TEST(InputPacket, MoreInputsThanTheLimitAreRefused) {
    InputPacket packet{.acked_snapshot_tick = 1, .first_sequence = 1, .inputs = {}};
    packet.inputs.assign(kMaxInputsPerPacket, {1, 2, false, false});
    Bytes bytes = encode(packet);
    ASSERT_TRUE(decode_input_packet(bytes));
    bytes.push_back(0);  // one more of the same
    EXPECT_FALSE(decode_input_packet(bytes));
}

TEST(InputPacket, SequenceNumbersDoNotWrap) {
    InputPacket packet{.acked_snapshot_tick = 0,
                       .first_sequence = std::numeric_limits<std::uint32_t>::max() - 1,
                       .inputs = {{1, 1, true, false}, {2, 2, true, false}}};
    EXPECT_TRUE(decode_input_packet(encode(packet)));
    packet.inputs.push_back({3, 3, true, false});
    EXPECT_FALSE(decode_input_packet(encode(packet)));
}

TEST(InputPacket, CutShortItIsNothingOrHasFewerInputs) {
    Rng rng(12);
    for (int i = 0; i < 200; ++i) {
        const InputPacket packet = any_packet(rng);
        const Bytes bytes = encode(packet);
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            const auto cut = decode_input_packet(std::span(bytes).first(size));
            if (!cut) continue;
            ASSERT_EQ(cut->first_sequence, packet.first_sequence);
            ASSERT_LT(cut->inputs.size(), packet.inputs.size());
            ASSERT_TRUE(std::equal(cut->inputs.begin(), cut->inputs.end(), packet.inputs.begin()));
        }
    }
}

TEST(SnapshotPacket, CarriesAPartAndAddsNoMoreThanItsOverhead) {
    Rng rng(6);
    const auto parts = encode_delta(Snapshot{}, testing::wild_snapshot(rng, 99, 40), 300);
    for (const auto& part : parts) {
        const SnapshotPacket packet{
            .acked_input_sequence = 0xFFFFFFFF, .input_slack = 77, .part = part};
        const Bytes bytes = encode(packet);
        EXPECT_LE(bytes.size(), part.size() + kMaxSnapshotPacketOverheadBytes);
        const auto back = decode_snapshot_packet(bytes);
        ASSERT_TRUE(back);
        EXPECT_EQ(back->acked_input_sequence, packet.acked_input_sequence);
        EXPECT_EQ(back->input_slack, packet.input_slack);
        EXPECT_EQ(back->part, part);
    }
}

TEST(SnapshotPacket, KeepsItsKind) {
    using Kind = SnapshotPacket::Kind;
    Snapshot baseline, outcome;
    baseline.tick = 94;
    outcome.tick = 96;
    const Bytes states = encode_delta({}, outcome, kMinPartBytes).front();
    const Bytes events = encode_events(baseline, {}, outcome);
    for (const Kind kind :
         {Kind::kStates, Kind::kSomeStates, Kind::kEvents, Kind::kEarlierEvents}) {
        const SnapshotPacket packet{.kind = kind, .part = tells_states(kind) ? states : events};
        const auto back = decode_snapshot_packet(encode(packet));
        ASSERT_TRUE(back);
        EXPECT_EQ(back->kind, kind);
        EXPECT_EQ(back->part, packet.part);
    }
    Bytes unknown = encode(SnapshotPacket{.part = states});
    unknown[0] = kSomeStatesPacketTag + 1;
    EXPECT_FALSE(decode_snapshot_packet(unknown));
}

TEST(SnapshotPacket, WithoutTheHeaderOfAPartIsNothing) {
    EXPECT_FALSE(
        decode_snapshot_packet(encode(SnapshotPacket{.acked_input_sequence = 1, .part = {}})));
    EXPECT_FALSE(decode_snapshot_packet(Bytes{kStatesPacketTag}));
    EXPECT_FALSE(decode_snapshot_packet(Bytes{kEventsPacketTag, 0, 5, 0}));
    EXPECT_FALSE(decode_snapshot_packet(Bytes{}));
}

TEST(UnreliablePayloads, TellEachOtherApartByTheirFirstByte) {
    const Bytes input = encode(InputPacket{});
    const Bytes snapshot =
        encode(SnapshotPacket{.acked_input_sequence = 0,
                              .part = encode_delta(Snapshot{}, Snapshot{}, kMinPartBytes).front()});
    EXPECT_TRUE(decode_input_packet(input));
    EXPECT_TRUE(decode_snapshot_packet(snapshot));
    EXPECT_FALSE(decode_input_packet(snapshot));
    EXPECT_FALSE(decode_snapshot_packet(input));
}

}  // namespace
}  // namespace fts::replication
