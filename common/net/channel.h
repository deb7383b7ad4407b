// One end of a session, in plaintext: what a packet holds (proto/WIRE.md, "Reliable channel").
// Writes packets that carry acknowledgements, an unreliable payload, fragments of reliable messages
// or a goodbye, and reads the other end's. Knows no key, address or socket; time is passed in.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/net/bytes.h"
#include "common/net/connection.h"
#include "common/net/reliable.h"
#include "common/net/sent_packets.h"
#include "common/net/sequence.h"

namespace fts::net {

inline constexpr std::size_t kSealedHeaderBytes = 1 + 4 + 8;
inline constexpr std::size_t kSealOverheadBytes = kSealedHeaderBytes + 16;
inline constexpr std::size_t kMaxPlaintextBytes = kMaxDatagramBytes - kSealOverheadBytes;

inline constexpr std::size_t kAckHeaderBytes = 4 + 8 + 2;
inline constexpr std::size_t kPayloadFrameBytes = 1 + 2;
inline constexpr std::size_t kFragmentFrameBytes = 1 + 4 + 1 + 2;
inline constexpr std::size_t kGoodbyeFrameBytes = 1 + 1 + 1;
// What a goodbye may say; the rest is cut off.
inline constexpr std::size_t kMaxDetailBytes = 200;
static_assert(kAckHeaderBytes + kPayloadFrameBytes + kMaxPayloadBytes <= kMaxPlaintextBytes);
static_assert(kAckHeaderBytes + kFragmentFrameBytes + kFragmentBytes <= kMaxPlaintextBytes);
static_assert(kAckHeaderBytes + kGoodbyeFrameBytes + kMaxDetailBytes <= kMaxPlaintextBytes);

// How long an acknowledgement waits for a packet that goes that way anyhow, and how many packets
// wait.
inline constexpr double kMaxAckDelayS = 0.02;
inline constexpr std::size_t kMaxUnansweredPackets = 24;
static_assert(kMaxUnansweredPackets < kAckBits);

class Channel {
  public:
    struct Goodbye {
        DisconnectReason reason = DisconnectReason::kClosed;
        std::string detail;
    };
    // What a packet brought.
    struct Received {
        std::vector<std::vector<std::uint8_t>> messages;
        std::optional<std::vector<std::uint8_t>> payload;
        std::optional<Goodbye> goodbye;
        std::optional<std::uint64_t> probe;         // to be answered with the same number
        std::optional<std::uint64_t> probe_answer;  // to a probe of ours
    };
    // A packet that has been written: it must be sent under this number, and under no other.
    struct Written {
        std::uint64_t number = 0;
        std::size_t size = 0;
    };
    using Plaintext = std::span<std::uint8_t, kMaxPlaintextBytes>;

    bool queue_reliable(Bytes message) { return sender_.queue(message); }
    // Call before anything is written at this time.
    void update(double now_s);
    bool has_fragments_due(double now_s) { return sender_.due(now_s, kFragmentBytes) != nullptr; }
    bool owes_answer(double now_s) const;
    bool owes_answer_at_once() const { return unanswered_ >= kMaxUnansweredPackets; }

    // Acknowledgements, and what fragments are due.
    Written write(double now_s, Plaintext out);
    // The same and a payload of at most kMaxPayloadBytes.
    Written write_payload(Bytes payload, double now_s, Plaintext out);
    // The same and a frame that makes the other end answer.
    Written write_ping(double now_s, Plaintext out);
    // Asks whether packets arrive where we send them, by a number that only who reads it can know.
    Written write_probe(std::uint64_t token, double now_s, Plaintext out);
    Written write_probe_answer(std::uint64_t token, double now_s, Plaintext out);
    Written write_goodbye(const Goodbye& goodbye, double now_s, Plaintext out);

    bool is_fresh(std::uint64_t number) const { return seen_.is_fresh(number); }
    bool is_newest(std::uint64_t number) const { return number > seen_.newest(); }
    // Reads a fresh packet. False when the peer broke the protocol: the session must end.
    bool read(std::uint64_t number, Bytes plaintext, double now_s, Received& received);

    const SentPackets& sent() const { return sent_; }

  private:
    ByteWriter begin(double now_s, Plaintext out);
    Written finish(ByteWriter& writer, double now_s);
    bool read_acknowledgement(ByteReader& reader, double now_s);
    bool read_frame(ByteReader& reader, Received& received, bool& asks_answer);
    bool read_fragment(ByteReader& reader, Received& received);

    SentPackets sent_;
    ReliableSender sender_;
    ReliableReceiver receiver_;
    ReplayWindow seen_;
    double newest_seen_at_s_ = 0.0;
    std::size_t unanswered_ = 0;
    double unanswered_since_s_ = 0.0;
};

// A goodbye's text as it may be shown: cut to kMaxDetailBytes between characters, control
// characters replaced.
std::string presentable(std::string_view detail);

}  // namespace fts::net
