#include "common/net/handshake.h"

#include <algorithm>

#include "common/net/noise.h"

namespace fts::net {
namespace {

constexpr std::size_t kResponseBytes =
    kHeaderBytes + 32 + NoiseXX::kMessage2Bytes + sizeof(ConnectionId);
constexpr std::size_t kFinishBytes = kHeaderBytes + sizeof(ConnectionId) + NoiseXX::kMessage3Bytes;
static_assert(kResponseBytes < kClientOpeningBytes);

class PacketWriter {
  public:
    PacketWriter(PacketType type, std::uint16_t version, std::size_t size)
        : datagram_(size), writer_(datagram_) {
        writer_.put_bytes(kMagic);
        writer_.put(static_cast<std::uint8_t>(type));
        writer_.put(version);
    }
    ByteWriter& fields() { return writer_; }
    Datagram take() { return std::move(datagram_); }

  private:
    Datagram datagram_;
    ByteWriter writer_;
};

std::vector<std::uint8_t> to_vector(Bytes bytes) {
    return {bytes.begin(), bytes.end()};
}

}  // namespace

bool has_magic(Bytes datagram) {
    return datagram.size() >= kMagic.size() &&
           std::equal(kMagic.begin(), kMagic.end(), datagram.begin());
}

std::optional<Header> decode_header(Bytes datagram) {
    if (!has_magic(datagram)) return std::nullopt;
    ByteReader reader(datagram.subspan(kMagic.size()));
    const auto type = reader.take<std::uint8_t>();
    const auto version = reader.take<std::uint16_t>();
    if (!reader.ok() || type < static_cast<std::uint8_t>(PacketType::kHello) ||
        type > static_cast<std::uint8_t>(PacketType::kRefused)) {
        return std::nullopt;
    }
    return Header{static_cast<PacketType>(type), version};
}

EphemeralKey echo_of(Bytes datagram) {
    return ByteReader(datagram.subspan(kHeaderBytes)).take_array<32>();
}

Datagram encode(const Hello& packet, std::uint16_t version) {
    PacketWriter writer(PacketType::kHello, version, kClientOpeningBytes);
    writer.fields().put_bytes(packet.ephemeral);
    return writer.take();
}

Datagram encode(const CookieReply& packet, std::uint16_t version) {
    PacketWriter writer(PacketType::kCookie, version, kCookieBytes);
    writer.fields().put_bytes(packet.echo);
    writer.fields().put_bytes(packet.cookie);
    return writer.take();
}

Datagram encode(const Connect& packet, std::uint16_t version) {
    PacketWriter writer(PacketType::kConnect, version, kClientOpeningBytes);
    writer.fields().put_bytes(packet.ephemeral);
    writer.fields().put_bytes(packet.cookie);
    return writer.take();
}

Datagram encode(const Response& packet, std::uint16_t version) {
    PacketWriter writer(PacketType::kResponse, version, kResponseBytes);
    writer.fields().put_bytes(packet.echo);
    writer.fields().put_bytes(packet.noise);
    return writer.take();
}

Datagram encode(const Finish& packet, std::uint16_t version) {
    PacketWriter writer(PacketType::kFinish, version, kFinishBytes);
    writer.fields().put(packet.id);
    writer.fields().put_bytes(packet.noise);
    return writer.take();
}

Datagram encode(const Refused& packet, std::uint16_t version) {
    PacketWriter writer(PacketType::kRefused, version, kRefusedBytes);
    writer.fields().put_bytes(packet.echo);
    writer.fields().put(static_cast<std::uint8_t>(packet.reason));
    return writer.take();
}

std::optional<Hello> decode_hello(Bytes datagram) {
    if (datagram.size() != kClientOpeningBytes) return std::nullopt;
    return Hello{echo_of(datagram)};
}

std::optional<CookieReply> decode_cookie(Bytes datagram) {
    if (datagram.size() != kCookieBytes) return std::nullopt;
    ByteReader reader(datagram.subspan(kHeaderBytes));
    CookieReply packet;
    packet.echo = reader.take_array<32>();
    packet.cookie = reader.take_array<32>();
    return packet;
}

std::optional<Connect> decode_connect(Bytes datagram) {
    if (datagram.size() != kClientOpeningBytes) return std::nullopt;
    ByteReader reader(datagram.subspan(kHeaderBytes));
    Connect packet;
    packet.ephemeral = reader.take_array<32>();
    packet.cookie = reader.take_array<32>();
    return packet;
}

std::optional<Response> decode_response(Bytes datagram) {
    if (datagram.size() != kResponseBytes) return std::nullopt;
    return Response{echo_of(datagram), to_vector(datagram.subspan(kHeaderBytes + 32))};
}

std::optional<Finish> decode_finish(Bytes datagram) {
    if (datagram.size() != kFinishBytes) return std::nullopt;
    ByteReader reader(datagram.subspan(kHeaderBytes));
    const auto id = reader.take<ConnectionId>();
    return Finish{id, to_vector(reader.rest())};
}

std::optional<Refused> decode_refused(Bytes datagram) {
    if (datagram.size() != kRefusedBytes) return std::nullopt;
    ByteReader reader(datagram.subspan(kHeaderBytes));
    const EphemeralKey echo = reader.take_array<32>();
    const auto reason = reader.take<std::uint8_t>();
    if (reason < static_cast<std::uint8_t>(RefusalReason::kWrongVersion) ||
        reason > static_cast<std::uint8_t>(RefusalReason::kMalformed)) {
        return std::nullopt;
    }
    return Refused{echo, static_cast<RefusalReason>(reason)};
}

std::vector<std::uint8_t> handshake_prologue(std::uint16_t version) {
    std::vector<std::uint8_t> prologue(kMagic.size() + sizeof(version));
    ByteWriter writer(prologue);
    writer.put_bytes(kMagic);
    writer.put(version);
    return prologue;
}

CookieJar::CookieJar() {
    fill_random(key_.bytes);
}

Cookie CookieJar::bake(const Address& address, const EphemeralKey& ephemeral, double now_s) const {
    return bake_for_slot(address, ephemeral,
                         static_cast<std::uint64_t>(std::max(now_s, 0.0) / kCookieSlotS));
}

bool CookieJar::recognises(const Cookie& cookie, const Address& address,
                           const EphemeralKey& ephemeral, double now_s) const {
    const auto slot = static_cast<std::uint64_t>(std::max(now_s, 0.0) / kCookieSlotS);
    return equal_in_constant_time(cookie, bake_for_slot(address, ephemeral, slot)) ||
           (slot > 0 &&
            equal_in_constant_time(cookie, bake_for_slot(address, ephemeral, slot - 1)));
}

Cookie CookieJar::bake_for_slot(const Address& address, const EphemeralKey& ephemeral,
                                std::uint64_t slot) const {
    std::array<std::uint8_t, 10> port_and_slot{};
    ByteWriter writer(port_and_slot);
    writer.put(address.port);
    writer.put(slot);
    return keyed_mac(key_, {address.ip, port_and_slot, ephemeral});
}

}  // namespace fts::net
