// Sessions over datagrams: a stateless cookie, an encrypted handshake, then two ways to send bytes.
// `Listener` is the accepting end of many sessions on one port, `Dialer` the calling end of one.
// Neither owns a socket or reads a clock: datagrams and time are passed in, datagrams go out
// through a Transport.
//
// Handshake: Noise_XX_25519_ChaChaPoly_BLAKE2b (libsodium, in cipher.cpp only). The first packet is
// padded to kMaxDatagramBytes and answered by a cookie that costs the server no memory; replies
// never exceed what came in before the address is proven. After it every packet is sealed with a
// counter as nonce; replays are dropped, and an address may change in mid-session.
//
// Nothing that arrives can crash, hang or grow it: each packet that is not understood is counted by
// reason and dropped. Not thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/net/identity.h"
#include "common/net/transport.h"

namespace fts::net {

// One more whenever an end of before could misread what an end of now sends, in a packet of this
// room or in what the packets carry: proto/WIRE.md, "Versions".
inline constexpr std::uint16_t kProtocolVersion = 2;

// The most bytes that one unreliable payload may hold.
inline constexpr std::size_t kMaxPayloadBytes = 1150;
// The most bytes of one reliable message (it is cut into fragments and put together again).
inline constexpr std::size_t kMaxMessageBytes = 64 * 1024;

inline constexpr double kDefaultTimeoutS = 5.0;

enum class DisconnectReason : std::uint8_t {
    kClosed,       // the other end said goodbye
    kTimeout,      // nothing arrived for timeout_s
    kUnreachable,  // the first packet was never answered
    kServerFull,
    kWrongVersion,   // the other end speaks another protocol version
    kRefused,        // the other end refused, `detail` says why
    kKeyChanged,     // the server's key is not the pinned one
    kProtocolError,  // the peer broke the protocol after the handshake
    kKicked,
};
std::string_view name_of(DisconnectReason reason);

using ConnectionId = std::uint32_t;

struct Connected {
    ConnectionId id = 0;
    PublicKey peer{};
    Address address;
};
struct Disconnected {
    ConnectionId id = 0;
    DisconnectReason reason = DisconnectReason::kClosed;
    std::string detail;              // human-readable; what the other end wrote, if anything
    std::uint16_t peer_version = 0;  // set with kWrongVersion
};
struct ReliableMessage {  // each exactly once, in the order sent
    ConnectionId id = 0;
    std::vector<std::uint8_t> bytes;
};
struct UnreliablePayload {  // at most once, any order
    ConnectionId id = 0;
    std::vector<std::uint8_t> bytes;
};
using Event = std::variant<Connected, Disconnected, ReliableMessage, UnreliablePayload>;

struct LinkStats {
    double rtt_s = 0.0;         // smoothed; 0 until measured
    double rtt_jitter_s = 0.0;  // smoothed mean deviation
    double loss = 0.0;  // share of recent packets of ours that were never acknowledged, [0, 1]
    std::uint64_t packets_sent = 0, packets_received = 0;
    std::uint64_t bytes_sent = 0, bytes_received = 0;
};

struct ListenerConfig {
    KeyPair key{};
    std::uint16_t protocol_version = kProtocolVersion;
    std::size_t max_connections = 64;
    double timeout_s = kDefaultTimeoutS;
};

class Listener {
  public:
    Listener(const ListenerConfig& config, Transport& transport);
    ~Listener();

    // One arrived datagram.
    void receive(const Address& from, std::span<const std::uint8_t> datagram, double now_s);
    // Resends, acknowledges, keeps alive, times out. Call once a tick.
    void update(double now_s);
    // Events in the order they happened; empties the queue.
    std::vector<Event> drain_events();

    // False when the session is gone, the payload too large or the reliable queue full.
    bool send_unreliable(ConnectionId id, std::span<const std::uint8_t> payload);
    bool send_reliable(ConnectionId id, std::span<const std::uint8_t> message);
    // Says goodbye; the session is gone at once, and its Disconnected event follows here too.
    void disconnect(ConnectionId id, DisconnectReason reason, std::string_view detail);
    // The same to everybody, as kClosed.
    void close(std::string_view detail);

    std::size_t connection_count() const;
    std::optional<LinkStats> stats(ConnectionId id) const;
    const DropCounters& drops() const;
    // The protocol version of the latest client that was refused for it ("wrong_version").
    std::optional<std::uint16_t> last_foreign_version() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

struct DialerConfig {
    KeyPair key{};
    Address server{};
    std::uint16_t protocol_version = kProtocolVersion;
    std::optional<PublicKey>
        pinned_server_key{};  // refuse any other; absent: accept, the caller pins it
    double timeout_s = kDefaultTimeoutS;
};

class Dialer {
  public:
    enum class State : std::uint8_t { kConnecting, kConnected, kDisconnected };

    Dialer(const DialerConfig& config, Transport& transport);
    ~Dialer();

    void receive(const Address& from, std::span<const std::uint8_t> datagram, double now_s);
    void update(double now_s);
    // ConnectionId is always 0 here.
    std::vector<Event> drain_events();

    bool send_unreliable(std::span<const std::uint8_t> payload);
    bool send_reliable(std::span<const std::uint8_t> message);
    // Says goodbye; a Disconnected event (kClosed) follows. Nothing when already disconnected.
    void close(std::string_view detail);

    State state() const;
    LinkStats stats() const;
    const DropCounters& drops() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fts::net
