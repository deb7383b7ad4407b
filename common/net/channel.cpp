#include "common/net/channel.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace fts::net {
namespace {

enum class Frame : std::uint8_t {
    kPayload = 1,
    kFragment = 2,
    kGoodbye = 3,
    kPing = 4,
    kProbe = 5,
    kProbeAnswer = 6,
};

constexpr double kAckDelayUnitS = 1e-4;
constexpr std::uint16_t kMaxAckDelayUnits = 65535;

// The reasons travel as their numbers.
static_assert(static_cast<int>(DisconnectReason::kTimeout) == 1);
static_assert(static_cast<int>(DisconnectReason::kServerFull) == 3);
static_assert(static_cast<int>(DisconnectReason::kRefused) == 5);
static_assert(static_cast<int>(DisconnectReason::kProtocolError) == 7);
static_assert(static_cast<int>(DisconnectReason::kKicked) == 8);

// What an end may say of its leaving; anything else is taken for a plain goodbye.
DisconnectReason reason_from_wire(std::uint8_t reason) {
    switch (static_cast<DisconnectReason>(reason)) {
        case DisconnectReason::kTimeout:
        case DisconnectReason::kServerFull:
        case DisconnectReason::kRefused:
        case DisconnectReason::kProtocolError:
        case DisconnectReason::kKicked:
            return static_cast<DisconnectReason>(reason);
        default:
            return DisconnectReason::kClosed;
    }
}

void put_frame(ByteWriter& writer, Frame frame) {
    writer.put(static_cast<std::uint8_t>(frame));
}

}  // namespace

std::string presentable(std::string_view detail) {
    std::size_t size = std::min(detail.size(), kMaxDetailBytes);
    const auto continues_character = [&](std::size_t at) {
        return (static_cast<unsigned char>(detail[at]) & 0xc0U) == 0x80U;
    };
    while (size > 0 && size < detail.size() && continues_character(size)) --size;
    std::string text(detail.substr(0, size));
    for (char& c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f) c = '?';
    }
    return text;
}

void Channel::update(double now_s) {
    sent_.update(now_s);
    sender_.update(now_s, sent_.resend_after_s());
}

bool Channel::owes_answer(double now_s) const {
    return unanswered_ > 0 && now_s - unanswered_since_s_ >= kMaxAckDelayS;
}

Channel::Written Channel::write(double now_s, Plaintext out) {
    ByteWriter writer = begin(now_s, out);
    return finish(writer, now_s);
}

Channel::Written Channel::write_payload(Bytes payload, double now_s, Plaintext out) {
    assert(payload.size() <= kMaxPayloadBytes);
    ByteWriter writer = begin(now_s, out);
    put_frame(writer, Frame::kPayload);
    writer.put(static_cast<std::uint16_t>(payload.size()));
    writer.put_bytes(payload);
    return finish(writer, now_s);
}

Channel::Written Channel::write_ping(double now_s, Plaintext out) {
    ByteWriter writer = begin(now_s, out);
    put_frame(writer, Frame::kPing);
    return finish(writer, now_s);
}

Channel::Written Channel::write_probe(std::uint64_t token, double now_s, Plaintext out) {
    ByteWriter writer = begin(now_s, out);
    put_frame(writer, Frame::kProbe);
    writer.put(token);
    return finish(writer, now_s);
}

Channel::Written Channel::write_probe_answer(std::uint64_t token, double now_s, Plaintext out) {
    ByteWriter writer = begin(now_s, out);
    put_frame(writer, Frame::kProbeAnswer);
    writer.put(token);
    return finish(writer, now_s);
}

Channel::Written Channel::write_goodbye(const Goodbye& goodbye, double now_s, Plaintext out) {
    ByteWriter writer = begin(now_s, out);
    const std::string detail = presentable(goodbye.detail);
    put_frame(writer, Frame::kGoodbye);
    writer.put(static_cast<std::uint8_t>(goodbye.reason));
    writer.put(static_cast<std::uint8_t>(detail.size()));
    for (const char c : detail) writer.put(static_cast<std::uint8_t>(c));
    const Written written{sent_.next_number(), writer.size()};
    sent_.record(now_s, {});
    return written;
}

ByteWriter Channel::begin(double now_s, Plaintext out) {
    const double waited_s = std::max(0.0, now_s - newest_seen_at_s_);
    const double units = std::min(std::round(waited_s / kAckDelayUnitS), double{kMaxAckDelayUnits});
    ByteWriter writer(out);
    writer.put(static_cast<std::uint32_t>(seen_.newest()));
    writer.put(seen_.seen_before_newest());
    writer.put(static_cast<std::uint16_t>(units));
    return writer;
}

Channel::Written Channel::finish(ByteWriter& writer, double now_s) {
    std::vector<std::uint64_t> fragments;
    while (writer.room() > kFragmentFrameBytes) {
        const Fragment* fragment = sender_.due(now_s, writer.room() - kFragmentFrameBytes);
        if (fragment == nullptr) break;
        put_frame(writer, Frame::kFragment);
        writer.put(static_cast<std::uint32_t>(fragment->number));
        writer.put(static_cast<std::uint8_t>(fragment->ends_message ? 1 : 0));
        writer.put(static_cast<std::uint16_t>(fragment->bytes.size()));
        writer.put_bytes(fragment->bytes);
        fragments.push_back(fragment->number);
        sender_.mark_sent(fragment->number, now_s);
    }
    unanswered_ = 0;
    const Written written{sent_.next_number(), writer.size()};
    sent_.record(now_s, std::move(fragments));
    return written;
}

bool Channel::read(std::uint64_t number, Bytes plaintext, double now_s, Received& received) {
    assert(is_fresh(number));
    if (is_newest(number)) newest_seen_at_s_ = now_s;
    seen_.mark(number);
    ByteReader reader(plaintext);
    if (!read_acknowledgement(reader, now_s)) return false;
    bool asks_answer = false;
    while (!reader.rest().empty()) {
        if (!read_frame(reader, received, asks_answer)) return false;
    }
    if (asks_answer) {
        if (unanswered_ == 0) unanswered_since_s_ = now_s;
        ++unanswered_;
    }
    return true;
}

bool Channel::read_acknowledgement(ByteReader& reader, double now_s) {
    const auto newest_low = reader.take<std::uint32_t>();
    const auto before_newest = reader.take<std::uint64_t>();
    const auto delay_units = reader.take<std::uint16_t>();
    if (!reader.ok()) return false;
    const std::uint64_t newest = nearest_with_low_bits(newest_low, sent_.next_number() - 1);
    std::vector<std::uint64_t> fragments;
    if (!sent_.acknowledge({newest, before_newest, delay_units * kAckDelayUnitS}, now_s,
                           fragments)) {
        return false;
    }
    for (const std::uint64_t fragment : fragments) sender_.acknowledge(fragment);
    return true;
}

bool Channel::read_frame(ByteReader& reader, Received& received, bool& asks_answer) {
    const auto frame = static_cast<Frame>(reader.take<std::uint8_t>());
    asks_answer = asks_answer || frame != Frame::kGoodbye;
    switch (frame) {
        case Frame::kPayload: {
            const auto size = reader.take<std::uint16_t>();
            const Bytes payload = reader.take_bytes(size);
            if (!reader.ok() || size > kMaxPayloadBytes || received.payload) return false;
            received.payload.emplace(payload.begin(), payload.end());
            return true;
        }
        case Frame::kFragment:
            return read_fragment(reader, received);
        case Frame::kGoodbye: {
            const DisconnectReason reason = reason_from_wire(reader.take<std::uint8_t>());
            const Bytes detail = reader.take_bytes(reader.take<std::uint8_t>());
            if (!reader.ok() || detail.size() > kMaxDetailBytes) return false;
            received.goodbye =
                Goodbye{reason, presentable(std::string(detail.begin(), detail.end()))};
            return true;
        }
        case Frame::kPing:
            return true;
        case Frame::kProbe:
            received.probe = reader.take<std::uint64_t>();
            return reader.ok();
        case Frame::kProbeAnswer:
            received.probe_answer = reader.take<std::uint64_t>();
            return reader.ok();
    }
    return false;
}

bool Channel::read_fragment(ByteReader& reader, Received& received) {
    const auto number_low = reader.take<std::uint32_t>();
    const auto ends_message = reader.take<std::uint8_t>();
    const auto size = reader.take<std::uint16_t>();
    const Bytes bytes = reader.take_bytes(size);
    if (!reader.ok() || ends_message > 1) return false;
    const std::uint64_t number = nearest_with_low_bits(number_low, receiver_.next_number());
    return receiver_.accept(number, ends_message == 1, bytes, received.messages);
}

}  // namespace fts::net
