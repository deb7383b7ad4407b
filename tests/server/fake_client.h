// A client of a few lines on an in-memory network: says what a test tells it to, and keeps
// everything that it hears.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/net/connection.h"
#include "common/replication/snapshot_receiver.h"
#include "common/replication/wire.h"
#include "tests/net/memory_network.h"

namespace fts::server {

class FakeClient {
  public:
    FakeClient(net::MemoryNetwork& network, const net::Address& server, std::uint8_t host,
               const net::KeyPair& key = net::generate_key_pair(),
               std::uint16_t version = net::kProtocolVersion)
        : key_(key),
          transport_(network, net::address_of(host, 40000)),
          dialer_({.key = key, .server = server, .protocol_version = version}, transport_) {}

    void update(double now_s) {
        transport_.poll(now_s,
                        [&](const net::Address& from, std::span<const std::uint8_t> datagram) {
                            dialer_.receive(from, datagram, now_s);
                        });
        if (sends_inputs && welcome()) send_input({});
        dialer_.update(now_s);
        for (const net::Event& event : dialer_.drain_events()) {
            std::visit([this](const auto& happened) { on(happened); }, event);
        }
    }

    void say(const replication::ClientMessage& message) {
        dialer_.send_reliable(replication::encode(message));
    }
    void say_nonsense() {
        dialer_.send_reliable(std::vector<std::uint8_t>{0xff, 0xff, 0xff, 0x07});
    }
    void send_input(const game::InputCommand& input) {
        send({receiver_.held_tick(), ++input_sequence, {input}});
    }
    void send(const replication::InputPacket& packet) {
        dialer_.send_unreliable(replication::encode(packet));
    }
    // As a message or as a payload, half and half.
    void send_raw(const std::vector<std::uint8_t>& bytes) {
        if (bytes.size() % 2 == 0) {
            dialer_.send_reliable(bytes);
        } else {
            dialer_.send_unreliable(bytes);
        }
    }
    void leave() { dialer_.close("bye"); }

    // All messages of one kind, in order.
    template <typename Message>
    std::vector<Message> heard() const {
        std::vector<Message> found;
        for (const auto& message : messages) {
            if (const auto* one = std::get_if<Message>(&message)) found.push_back(*one);
        }
        return found;
    }
    template <typename Message>
    std::optional<Message> last() const {
        const auto all = heard<Message>();
        return all.empty() ? std::nullopt : std::optional<Message>(all.back());
    }
    std::optional<replication::Welcome> welcome() const { return last<replication::Welcome>(); }
    bool is_connected() const { return dialer_.state() == net::Dialer::State::kConnected; }
    const net::KeyPair& key() const { return key_; }

    std::vector<replication::ServerMessage> messages;
    std::optional<net::Disconnected> disconnected;
    replication::Snapshot snapshot;  // the newest whole one
    std::uint64_t snapshots = 0;
    std::uint64_t replayed = 0;    // of the snapshots
    replication::Snapshot sketch;  // the newest one
    std::uint64_t sketches = 0, keyframe_parts = 0;
    std::uint32_t acked_input_sequence = 0;
    std::uint32_t input_sequence = 0;
    bool sends_inputs = true;

  private:
    void on(const net::Connected&) {}
    void on(const net::Disconnected& event) { disconnected = event; }
    void on(const net::ReliableMessage& event) {
        auto message = replication::decode_server_message(event.bytes);
        ASSERT_TRUE(message);
        if (const auto* part = std::get_if<replication::KeyframePart>(&*message)) {
            ++keyframe_parts;
            return take(receiver_.receive(*part, 2, courses_));
        }
        messages.push_back(std::move(*message));
    }
    void on(const net::UnreliablePayload& event) {
        const auto packet = replication::decode_snapshot_packet(event.bytes);
        ASSERT_TRUE(packet);
        acked_input_sequence = packet->acked_input_sequence;
        const auto received = receiver_.receive(*packet, 2, courses_);
        if (received.exact && received.snapshot &&
            packet->kind == replication::SnapshotPacket::Kind::kEvents) {
            ++replayed;
        }
        take(received);
    }
    void take(const replication::SnapshotReceiver::Received& received) {
        if (!received.snapshot) return;
        if (!received.exact) {
            sketch = *received.snapshot;
            ++sketches;
            return;
        }
        snapshot = *received.snapshot;
        ++snapshots;
    }
    std::optional<replication::Course> course_of(int number) const {
        for (const auto& level : heard<replication::LevelStarted>()) {
            if (level.number == number) {
                return replication::course_of(level.platform, level.solver);
            }
        }
        return std::nullopt;
    }

    net::KeyPair key_;
    net::MemoryTransport transport_;
    net::Dialer dialer_;
    replication::SnapshotReceiver receiver_;
    const replication::SnapshotReceiver::CourseOf courses_ = [this](int level) {
        return course_of(level);
    };
};

}  // namespace fts::server
