// A sealed session, the same at both ends: a Channel whose packets are sealed, numbered, and sent
// to an address that may change. Time is passed in; transport and counters must outlive it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "common/net/channel.h"
#include "common/net/connection.h"
#include "common/net/noise.h"

namespace fts::net {

// First byte of a sealed packet; no handshake packet begins with it.
inline constexpr std::uint8_t kSealedMarker = 'S';
// Events wait for the next drain. When so many do, packets are dropped until then; what is reliable
// is sent again.
inline constexpr std::size_t kMaxWaitingEvents = 65536;
// A session that has nothing to say says so this often.
inline constexpr double kKeepAliveS = 0.5;
// A goodbye is not acknowledged, so it is said more than once.
inline constexpr int kGoodbyeCopies = 4;
// What may be sent to an address that a session moved to, for each byte that came from it, until
// the session has proven to receive there (as in RFC 9000, section 8.1).
inline constexpr std::size_t kUnprovenFactor = 3;
// How often it is asked to prove it.
inline constexpr double kProbeIntervalS = 0.1;

// The session that a sealed packet belongs to; nothing when it is not one.
std::optional<ConnectionId> sealed_packet_id(Bytes datagram);

class Session {
  public:
    Session(ConnectionId id, const SessionKeys& keys, const Address& peer, double timeout_s,
            double now_s, Transport& transport, DropCounters& drops);

    enum class Outcome : std::uint8_t { kAccepted, kDropped, kProtocolError };
    // Takes a packet of this session. What was dropped has been counted.
    Outcome receive(const Address& from, Bytes datagram, double now_s, Channel::Received& received);

    // False when it is too large.
    bool send_payload(Bytes payload, double now_s);
    bool queue_reliable(Bytes message) { return channel_.queue_reliable(message); }
    // Sends at once what makes the other end answer.
    void ping(double now_s);
    // Sends fragments, answers and keep-alives that are due.
    void update(double now_s);
    void say_goodbye(DisconnectReason reason, std::string_view detail, double now_s);

    bool has_timed_out(double now_s) const { return now_s - heard_at_s_ > timeout_s_; }
    double timeout_s() const { return timeout_s_; }
    const Address& address() const { return address_; }
    LinkStats stats() const;

  private:
    void transmit(const Channel::Written& written, double now_s);
    void follow_address(const Address& from, std::size_t bytes);
    void probe(double now_s);

    ConnectionId id_;
    SessionKeys keys_;
    Channel channel_;
    Transport& transport_;
    DropCounters& drops_;
    double timeout_s_;
    double heard_at_s_;
    double sent_at_s_;

    Address address_;
    Address proven_address_;
    bool is_proven_ = true;
    std::uint64_t probe_token_ = 0;
    double probed_at_s_ = 0.0;
    std::size_t allowance_bytes_ = 0;

    std::array<std::uint8_t, kMaxPlaintextBytes> plaintext_{};
    std::uint64_t packets_sent_ = 0, packets_received_ = 0;
    std::uint64_t bytes_sent_ = 0, bytes_received_ = 0;
};

// Appends what a packet brought to `events`, as of connection `id`; the goodbye is left to the
// caller.
void append_events(ConnectionId id, Channel::Received&& received, std::vector<Event>& events);

}  // namespace fts::net
