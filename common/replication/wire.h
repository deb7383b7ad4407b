// Bytes <-> values: the only door to Protobuf in this room (wire.cpp includes arena.pb.h). Decoding
// returns a value or nothing, and never asserts: what is unknown or out of its range is nothing,
// and so is a missing part of a message (a number that is absent is zero, as in proto3, and must be
// in range).
//
// The limits below hold both ways. `encode` gives no bytes for a message that the other end would
// refuse; there is then nothing to send, and the caller has a mistake to report.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/game/rules.h"
#include "common/replication/messages.h"

namespace fts::replication {

// The first byte of an unreliable payload says what it is.
inline constexpr std::uint8_t kInputPacketTag = 0x01;
inline constexpr std::uint8_t kStatesPacketTag = 0x02;
inline constexpr std::uint8_t kEventsPacketTag = 0x03;
inline constexpr std::uint8_t kEarlierEventsPacketTag = 0x04;
inline constexpr std::uint8_t kSomeStatesPacketTag = 0x05;
// What a SnapshotPacket adds to its part, at most.
inline constexpr std::size_t kMaxSnapshotPacketOverheadBytes = 7;
// A tag, two varints, and inputs that all differ.
inline constexpr std::size_t kMaxInputPacketBytes = 1 + 2 * 5 + 3 * kMaxInputsPerPacket;

// Texts are well-formed UTF-8. The name in a JoinRequest is as the player typed it and may have
// kMaxTextBytes; the one in a PlayerInfo has game::kMaxNameBytes at most. A ChatRequest has
// game::kMaxChatBytes at most; a ChatLine, which may be the server's own, kMaxTextBytes, like any
// other text.
inline constexpr std::size_t kMaxTextBytes = 512;
inline constexpr std::size_t kMaxControlMessageBytes = 8 * 1024;
// Players in a Roster, shares in a KnockOff.
inline constexpr std::size_t kMaxPlayersInMessage = game::kMaxPlayersPerArena;
// A PlayerInfo's name, and the rest: five counts (25), an id and a colour (6), a flag (1), and two
// bytes of key and length for each and for itself (20).
inline constexpr std::size_t kMaxPlayerInfoBytes = game::kMaxNameBytes + 52;
static_assert(kMaxPlayersInMessage * kMaxPlayerInfoBytes < kMaxControlMessageBytes);
static_assert(static_cast<std::size_t>(game::kMaxChatBytes) <= kMaxTextBytes);
static_assert(static_cast<std::size_t>(game::kMaxNameBytes) <= kMaxTextBytes);

std::vector<std::uint8_t> encode(const ClientMessage& message);
std::vector<std::uint8_t> encode(const ServerMessage& message);
std::vector<std::uint8_t> encode(const InputPacket& packet);  // at most kMaxInputsPerPacket inputs
std::vector<std::uint8_t> encode(const SnapshotPacket& packet);

std::optional<ClientMessage> decode_client_message(std::span<const std::uint8_t> bytes);
std::optional<ServerMessage> decode_server_message(std::span<const std::uint8_t> bytes);
std::optional<InputPacket> decode_input_packet(std::span<const std::uint8_t> bytes);
std::optional<SnapshotPacket> decode_snapshot_packet(std::span<const std::uint8_t> bytes);

}  // namespace fts::replication
