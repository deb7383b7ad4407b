// The packets before a session is sealed, byte for byte (proto/WIRE.md, "Handshake"), and the
// cookie that proves an address without any memory. Decoding takes any bytes and never fails but by
// nothing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/net/cipher.h"
#include "common/net/connection.h"

namespace fts::net {

inline constexpr std::array<std::uint8_t, 4> kMagic{'F', 'T', 'S', 'A'};

enum class PacketType : std::uint8_t {
    kHello = 1,     // client: magic, type, version, ephemeral key, padding
    kCookie = 2,    // server: header, the client's ephemeral key, cookie
    kConnect = 3,   // client: header, ephemeral key, cookie, padding
    kResponse = 4,  // server: header, the client's ephemeral key, Noise message 2
    kFinish = 5,    // client: header, session id, Noise message 3
    kRefused = 6,   // server: header, the client's ephemeral key, reason
};

enum class RefusalReason : std::uint8_t { kWrongVersion = 1, kServerFull = 2, kMalformed = 3 };

// Names the client's attempt: who cannot see it cannot answer it.
using EphemeralKey = PublicKey;
using Cookie = Mac;

inline constexpr std::size_t kHeaderBytes = kMagic.size() + 1 + 2;
inline constexpr std::size_t kCookieBytes = kHeaderBytes + 32 + 32;
inline constexpr std::size_t kRefusedBytes = kHeaderBytes + 32 + 1;
// Version and ephemeral key stand where they do for good, so that any two versions understand a
// refusal.
inline constexpr std::size_t kClientOpeningBytes = kMaxDatagramBytes;
static_assert(kCookieBytes < kClientOpeningBytes, "a reply must be smaller than what it answers");

struct Header {
    PacketType type = PacketType::kHello;
    std::uint16_t version = 0;
};
// Nothing when the magic is missing or the type unknown.
std::optional<Header> decode_header(Bytes datagram);
bool has_magic(Bytes datagram);
// The 32 bytes after the header: what a refusal echoes. Needs kHeaderBytes + 32 bytes.
EphemeralKey echo_of(Bytes datagram);

struct Hello {
    EphemeralKey ephemeral{};
};
struct CookieReply {
    EphemeralKey echo{};
    Cookie cookie{};
};
struct Connect {
    EphemeralKey ephemeral{};
    Cookie cookie{};
};
struct Response {
    EphemeralKey echo{};
    std::vector<std::uint8_t> noise;
};
struct Finish {
    ConnectionId id = 0;
    std::vector<std::uint8_t> noise;
};
struct Refused {
    EphemeralKey echo{};
    RefusalReason reason = RefusalReason::kMalformed;
};

using Datagram = std::vector<std::uint8_t>;
Datagram encode(const Hello& packet, std::uint16_t version);
Datagram encode(const CookieReply& packet, std::uint16_t version);
Datagram encode(const Connect& packet, std::uint16_t version);
Datagram encode(const Response& packet, std::uint16_t version);
Datagram encode(const Finish& packet, std::uint16_t version);
Datagram encode(const Refused& packet, std::uint16_t version);

// Each expects the header to have been decoded and to be of its type.
std::optional<Hello> decode_hello(Bytes datagram);
std::optional<CookieReply> decode_cookie(Bytes datagram);
std::optional<Connect> decode_connect(Bytes datagram);
std::optional<Response> decode_response(Bytes datagram);
std::optional<Finish> decode_finish(Bytes datagram);
std::optional<Refused> decode_refused(Bytes datagram);

// What both ends mix into the handshake before its first message.
std::vector<std::uint8_t> handshake_prologue(std::uint16_t version);

// Bakes and recognises cookies with a key of its own. One is good for kCookieSlotS to twice that.
class CookieJar {
  public:
    static constexpr double kCookieSlotS = 5.0;

    CookieJar();
    Cookie bake(const Address& address, const EphemeralKey& ephemeral, double now_s) const;
    bool recognises(const Cookie& cookie, const Address& address, const EphemeralKey& ephemeral,
                    double now_s) const;

  private:
    Cookie bake_for_slot(const Address& address, const EphemeralKey& ephemeral,
                         std::uint64_t slot) const;
    SymmetricKey key_;
};

}  // namespace fts::net
