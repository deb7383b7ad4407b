#include "common/net/session.h"

#include <algorithm>

#include "common/net/drops.h"

namespace fts::net {

std::optional<ConnectionId> sealed_packet_id(Bytes datagram) {
    if (datagram.size() < kSealOverheadBytes + kAckHeaderBytes ||
        datagram.size() > kMaxDatagramBytes || datagram[0] != kSealedMarker) {
        return std::nullopt;
    }
    return ByteReader(datagram.subspan(1)).take<ConnectionId>();
}

Session::Session(ConnectionId id, const SessionKeys& keys, const Address& peer, double timeout_s,
                 double now_s, Transport& transport, DropCounters& drops)
    : id_(id),
      keys_(keys),
      transport_(transport),
      drops_(drops),
      timeout_s_(timeout_s),
      heard_at_s_(now_s),
      sent_at_s_(now_s),
      address_(peer),
      proven_address_(peer) {}

Session::Outcome Session::receive(const Address& from, Bytes datagram, double now_s,
                                  Channel::Received& received) {
    const Bytes header = datagram.first(kSealedHeaderBytes);
    const Bytes sealed = datagram.subspan(kSealedHeaderBytes);
    const auto number = ByteReader(header.subspan(1 + sizeof(ConnectionId))).take<std::uint64_t>();
    if (!channel_.is_fresh(number)) {
        ++drops_[drop::kReplayed];
        return Outcome::kDropped;
    }
    std::array<std::uint8_t, kMaxPlaintextBytes> opened{};
    const auto plaintext = std::span(opened).first(sealed.size() - kTagBytes);
    if (!open(keys_.receive, number, header, sealed, plaintext)) {
        ++drops_[drop::kBadSeal];
        return Outcome::kDropped;
    }
    heard_at_s_ = now_s;
    ++packets_received_;
    bytes_received_ += datagram.size();
    if (channel_.is_newest(number)) follow_address(from, datagram.size());
    if (!channel_.read(number, plaintext, now_s, received)) {
        ++drops_[drop::kProtocolError];
        return Outcome::kProtocolError;
    }
    if (!is_proven_ && received.probe_answer == probe_token_) {
        is_proven_ = true;
        proven_address_ = address_;
    }
    if (received.probe) {
        transmit(channel_.write_probe_answer(*received.probe, now_s, plaintext_), now_s);
    }
    if (channel_.owes_answer_at_once()) transmit(channel_.write(now_s, plaintext_), now_s);
    return Outcome::kAccepted;
}

bool Session::send_payload(Bytes payload, double now_s) {
    if (payload.size() > kMaxPayloadBytes) return false;
    transmit(channel_.write_payload(payload, now_s, plaintext_), now_s);
    return true;
}

void Session::ping(double now_s) {
    transmit(channel_.write_ping(now_s, plaintext_), now_s);
}

void Session::update(double now_s) {
    channel_.update(now_s);
    if (!is_proven_ && now_s - probed_at_s_ >= kProbeIntervalS) probe(now_s);
    while (channel_.has_fragments_due(now_s)) transmit(channel_.write(now_s, plaintext_), now_s);
    if (channel_.owes_answer(now_s)) transmit(channel_.write(now_s, plaintext_), now_s);
    if (now_s - sent_at_s_ >= std::min(kKeepAliveS, timeout_s_ / 4.0)) ping(now_s);
}

void Session::say_goodbye(DisconnectReason reason, std::string_view detail, double now_s) {
    const Channel::Goodbye goodbye{reason, std::string(detail)};
    for (int i = 0; i < kGoodbyeCopies; ++i) {
        transmit(channel_.write_goodbye(goodbye, now_s, plaintext_), now_s);
    }
}

void Session::transmit(const Channel::Written& written, double now_s) {
    std::array<std::uint8_t, kMaxDatagramBytes> datagram{};
    ByteWriter header(datagram);
    header.put(kSealedMarker);
    header.put(id_);
    header.put(written.number);
    const auto whole = std::span(datagram).first(kSealOverheadBytes + written.size);
    seal(keys_.send, written.number, whole.first(kSealedHeaderBytes),
         std::span(plaintext_).first(written.size), whole.subspan(kSealedHeaderBytes));
    sent_at_s_ = now_s;
    if (!is_proven_) {
        if (allowance_bytes_ < whole.size()) {
            ++drops_[drop::kUnprovenAddress];
            return;
        }
        allowance_bytes_ -= whole.size();
    }
    ++packets_sent_;
    bytes_sent_ += whole.size();
    transport_.send(address_, whole);
}

void Session::follow_address(const Address& from, std::size_t bytes) {
    if (from != address_) {
        address_ = from;
        is_proven_ = from == proven_address_;
        std::array<std::uint8_t, sizeof(probe_token_)> random{};
        fill_random(random);
        probe_token_ = ByteReader(random).take<std::uint64_t>();
        probed_at_s_ = -kProbeIntervalS;
        allowance_bytes_ = 0;
    }
    if (!is_proven_) allowance_bytes_ += kUnprovenFactor * bytes;
}

void Session::probe(double now_s) {
    probed_at_s_ = now_s;
    transmit(channel_.write_probe(probe_token_, now_s, plaintext_), now_s);
}

LinkStats Session::stats() const {
    const SentPackets& sent = channel_.sent();
    return {sent.rtt_s(),      sent.rtt_jitter_s(), sent.loss(),    packets_sent_,
            packets_received_, bytes_sent_,         bytes_received_};
}

void append_events(ConnectionId id, Channel::Received&& received, std::vector<Event>& events) {
    for (auto& message : received.messages) {
        events.emplace_back(ReliableMessage{id, std::move(message)});
    }
    if (received.payload) events.emplace_back(UnreliablePayload{id, std::move(*received.payload)});
}

}  // namespace fts::net
