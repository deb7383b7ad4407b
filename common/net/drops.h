// The reasons for which a packet is dropped, by a session and by a socket. Every one is there from
// the start, at 0, so that what reads the counters sees a fixed set.
#pragma once

#include <string_view>

#include "common/net/connection.h"

namespace fts::net::drop {

inline constexpr std::string_view kMalformed = "malformed";    // not one of our packets
inline constexpr std::string_view kUnexpected = "unexpected";  // ours, at the wrong time
inline constexpr std::string_view kWrongVersion = "wrong_version";
inline constexpr std::string_view kBadCookie = "bad_cookie";  // stale, or of another address
inline constexpr std::string_view kBadHandshake =
    "bad_handshake";  // a Noise message that is not valid
inline constexpr std::string_view kServerFull = "server_full";
inline constexpr std::string_view kHalfOpenLimit = "half_open_limit";
inline constexpr std::string_view kUnknownSession = "unknown_session";
inline constexpr std::string_view kReplayed = "replayed";
inline constexpr std::string_view kBadSeal = "bad_seal";  // altered, or sealed by another key
inline constexpr std::string_view kProtocolError = "protocol_error";
inline constexpr std::string_view kEventsFull = "events_full";  // nobody drained the events
inline constexpr std::string_view kUnprovenAddress = "unproven_address";  // ours, held back

inline DropCounters make_counters() {
    return {{kMalformed, 0},      {kUnexpected, 0}, {kWrongVersion, 0},  {kBadCookie, 0},
            {kBadHandshake, 0},   {kServerFull, 0}, {kHalfOpenLimit, 0}, {kUnknownSession, 0},
            {kReplayed, 0},       {kBadSeal, 0},    {kProtocolError, 0}, {kEventsFull, 0},
            {kUnprovenAddress, 0}};
}

// Of a socket.
inline constexpr std::string_view kSendTooLarge = "send_too_large";
inline constexpr std::string_view kSendUnroutable = "send_unroutable";  // IPv6 through IPv4
inline constexpr std::string_view kSendBufferFull = "send_buffer_full";
inline constexpr std::string_view kSendFailed = "send_failed";
inline constexpr std::string_view kPeerUnreachable = "peer_unreachable";  // as its machine said
inline constexpr std::string_view kReceiveFailed = "receive_failed";
inline constexpr std::string_view kReceiveBufferFull = "receive_buffer_full";

inline DropCounters make_transport_counters() {
    return {{kSendTooLarge, 0},    {kSendUnroutable, 0}, {kSendBufferFull, 0},   {kSendFailed, 0},
            {kPeerUnreachable, 0}, {kReceiveFailed, 0},  {kReceiveBufferFull, 0}};
}

}  // namespace fts::net::drop
