// The two unreliable payloads: our own bytes, no Protobuf.
#include <algorithm>
#include <cassert>
#include <limits>

#include "common/replication/byte_stream.h"
#include "common/replication/control_events.h"
#include "common/replication/delta.h"
#include "common/replication/wire.h"

namespace fts::replication {
namespace {

constexpr std::uint8_t kBrake = 0x01;
constexpr std::uint8_t kDash = 0x02;
constexpr std::uint8_t kThrustFollows = 0x04;
constexpr unsigned kRepeatShift = 3;
constexpr std::size_t kMaxRun = 32;
static_assert(kMaxRun == (0x100U >> kRepeatShift));

using Inputs = std::vector<game::InputCommand>;
using PacketKind = SnapshotPacket::Kind;

void write_run(ByteWriter& out, const game::InputCommand& before, const game::InputCommand& input,
               std::size_t run) {
    const bool same_thrust = input.thrust_x == before.thrust_x && input.thrust_y == before.thrust_y;
    auto head = static_cast<std::uint8_t>((run - 1) << kRepeatShift);
    if (input.brake) head |= kBrake;
    if (input.dash) head |= kDash;
    if (!same_thrust) head |= kThrustFollows;
    out.u8(head);
    if (same_thrust) return;
    out.u8(static_cast<std::uint8_t>(input.thrust_x));
    out.u8(static_cast<std::uint8_t>(input.thrust_y));
}

bool read_run(ByteReader& in, Inputs& inputs) {
    game::InputCommand input = inputs.empty() ? game::InputCommand{} : inputs.back();
    const std::uint8_t head = in.u8();
    input.brake = (head & kBrake) != 0;
    input.dash = (head & kDash) != 0;
    if (head & kThrustFollows) {
        input.thrust_x = static_cast<std::int8_t>(in.u8());
        input.thrust_y = static_cast<std::int8_t>(in.u8());
    }
    const std::size_t run = (head >> kRepeatShift) + std::size_t{1};
    if (in.failed() || inputs.size() + run > kMaxInputsPerPacket) return false;
    inputs.insert(inputs.end(), run, input);
    return true;
}

std::uint8_t tag_of(PacketKind kind) {
    switch (kind) {
        case PacketKind::kStates:
            return kStatesPacketTag;
        case PacketKind::kSomeStates:
            return kSomeStatesPacketTag;
        case PacketKind::kEvents:
            return kEventsPacketTag;
        case PacketKind::kEarlierEvents:
            return kEarlierEventsPacketTag;
    }
    return 0;
}

std::optional<PacketKind> kind_of(std::uint8_t tag) {
    for (const PacketKind kind : {PacketKind::kStates, PacketKind::kSomeStates, PacketKind::kEvents,
                                  PacketKind::kEarlierEvents}) {
        if (tag_of(kind) == tag) return kind;
    }
    return std::nullopt;
}

}  // namespace

bool tells_states(SnapshotPacket::Kind kind) {
    return kind == PacketKind::kStates || kind == PacketKind::kSomeStates;
}

std::vector<std::uint8_t> encode(const InputPacket& packet) {
    assert(packet.inputs.size() <= kMaxInputsPerPacket);
    ByteWriter out;
    out.u8(kInputPacketTag);
    out.varint(packet.acked_snapshot_tick);
    out.varint(packet.first_sequence);
    game::InputCommand before;
    for (auto first = packet.inputs.begin(); first != packet.inputs.end();) {
        const auto last = std::find_if(first, packet.inputs.end(),
                                       [&](const auto& input) { return input != *first; });
        write_run(out, before, *first, static_cast<std::size_t>(last - first));
        before = *first;
        first = last;
    }
    return out.take();
}

std::optional<InputPacket> decode_input_packet(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes);
    if (in.u8() != kInputPacketTag) return std::nullopt;
    InputPacket packet;
    packet.acked_snapshot_tick = in.varint();
    packet.first_sequence = in.varint();
    while (!in.failed() && !in.complete()) {
        if (!read_run(in, packet.inputs)) return std::nullopt;
    }
    const std::size_t sequences_left =
        std::numeric_limits<std::uint32_t>::max() - packet.first_sequence + std::size_t{1};
    if (in.failed() || packet.inputs.size() > sequences_left) return std::nullopt;
    return packet;
}

std::vector<std::uint8_t> encode(const SnapshotPacket& packet) {
    ByteWriter out;
    out.u8(tag_of(packet.kind));
    out.varint(packet.acked_input_sequence);
    out.u8(packet.input_slack);
    out.append(packet.part);
    return out.take();
}

std::optional<SnapshotPacket> decode_snapshot_packet(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes);
    const auto kind = kind_of(in.u8());
    if (!kind) return std::nullopt;
    SnapshotPacket packet;
    packet.kind = *kind;
    packet.acked_input_sequence = in.varint();
    packet.input_slack = in.u8();
    if (in.failed()) return std::nullopt;
    const bool is_a_part = tells_states(packet.kind) ? peek_part(in.rest()).has_value()
                                                     : peek_control_part(in.rest()).has_value();
    if (!is_a_part) return std::nullopt;
    packet.part.assign(in.rest().begin(), in.rest().end());
    return packet;
}

}  // namespace fts::replication
