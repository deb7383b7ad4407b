// Bytes <-> values: the only door to Protobuf in this room (wire.cpp includes arena.pb.h). Decoding
// returns a value or nothing, and never asserts: unknown, missing or out-of-range fields are nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/replication/messages.h"

namespace fts::replication {

std::vector<std::uint8_t> encode(const ClientMessage& message);
std::vector<std::uint8_t> encode(const ServerMessage& message);
std::vector<std::uint8_t> encode(const InputPacket& packet);
std::vector<std::uint8_t> encode(const SnapshotPacket& packet);

std::optional<ClientMessage> decode_client_message(std::span<const std::uint8_t> bytes);
std::optional<ServerMessage> decode_server_message(std::span<const std::uint8_t> bytes);
std::optional<InputPacket> decode_input_packet(std::span<const std::uint8_t> bytes);
std::optional<SnapshotPacket> decode_snapshot_packet(std::span<const std::uint8_t> bytes);

}  // namespace fts::replication
