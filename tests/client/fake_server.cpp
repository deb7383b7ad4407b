#include "tests/client/fake_server.h"

#include <algorithm>
#include <utility>

#include "common/replication/delta.h"
#include "common/replication/wire.h"

namespace fts::client {
namespace {

constexpr replication::Tick kTicksPerSnapshot = 2;

net::ListenerConfig with_key(net::ListenerConfig config, const net::KeyPair& key) {
    config.key = key;
    return config;
}

}  // namespace

FakeServer::FakeServer(net::MemoryNetwork& network, const net::ListenerConfig& config)
    : key_(net::generate_key_pair()),
      transport_(network, address()),
      listener_(with_key(config, key_), transport_) {}

physics::Vec2d FakeServer::ball_at_m(double server_s) {
    return {-4.0 + 0.5 * (server_s - 16.0), 2.0 - 0.25 * (server_s - 16.0)};
}

void FakeServer::tick(double now_s) {
    transport_.poll(now_s, [&](const net::Address& from, std::span<const std::uint8_t> datagram) {
        listener_.receive(from, datagram, now_s);
    });
    for (const net::Event& event : listener_.drain_events()) handle(event);
    ++now_tick;
    if (joined_ && now_tick % kTicksPerSnapshot == 0) send_snapshot();
    listener_.update(now_s);
}

void FakeServer::handle(const net::Event& event) {
    if (const auto* connected = std::get_if<net::Connected>(&event)) {
        client_ = connected->id;
        newest_acked_ = 0;
        last_applied = 0;
    } else if (const auto* gone = std::get_if<net::Disconnected>(&event)) {
        disconnected = *gone;
        client_.reset();
        joined_ = false;
    } else if (const auto* message = std::get_if<net::ReliableMessage>(&event)) {
        const auto decoded = replication::decode_client_message(message->bytes);
        if (!decoded) return;
        received.push_back(*decoded);
        if (!std::holds_alternative<replication::JoinRequest>(*decoded)) return;
        joined_ = !refuse_everybody;
        if (refuse_everybody) {
            send(replication::JoinRefused{"we are closed"});
        } else {
            send(welcome);
        }
    } else if (const auto* payload = std::get_if<net::UnreliablePayload>(&event)) {
        if (const auto packet = replication::decode_input_packet(payload->bytes)) {
            take_inputs(*packet);
        }
    }
}

void FakeServer::take_inputs(const replication::InputPacket& packet) {
    if (packet.acked_snapshot_tick != 0) {
        acked_ticks.insert(packet.acked_snapshot_tick);
        newest_acked_ = std::max(newest_acked_, packet.acked_snapshot_tick);
    }
    if (packet.first_sequence > last_applied + 1) {
        sequences_lost += packet.first_sequence - last_applied - 1;
        last_applied = packet.first_sequence - 1;
    }
    for (std::size_t i = 0; i < packet.inputs.size(); ++i) {
        if (packet.first_sequence + i != last_applied + 1) continue;
        applied.push_back(packet.inputs[i]);
        ++last_applied;
    }
}

void FakeServer::send_snapshot() {
    auto snapshot = std::make_shared<replication::Snapshot>();
    snapshot->tick = now_tick;
    snapshot->phase = phase;
    snapshot->level = 1;
    const physics::Vec2d at_m = ball_at_m(now_tick / 60.0);
    replication::BallState ball;
    ball.id = 3;
    ball.kind = static_cast<std::uint8_t>(replication::BallKind::kPlayer);
    ball.player_id = welcome.player_id;
    ball.radius = 2048;
    ball.mass = 65536;
    ball.x = replication::quantise(at_m.x(), replication::kPositionStepM);
    ball.y = replication::quantise(at_m.y(), replication::kPositionStepM);
    ball.vx = replication::quantise(0.5, replication::kVelocityStepMps);
    ball.vy = replication::quantise(-0.25, replication::kVelocityStepMps);
    snapshot->balls.push_back(ball);
    history_.add(snapshot);
    sent_ticks.insert(now_tick);
    if (std::exchange(skip_next_, false)) return;
    const auto held = history_.find(newest_acked_);
    ++(held ? deltas_sent : keyframes_sent);
    const replication::Snapshot nothing;
    const auto parts = replication::encode_delta(held ? *held : nothing, *snapshot, 1000);
    for (const auto& part : parts) {
        listener_.send_unreliable(
            *client_,
            replication::encode(replication::SnapshotPacket{
                .acked_input_sequence = last_applied, .input_slack = input_slack, .part = part}));
    }
}

void FakeServer::send(const replication::ServerMessage& message) {
    listener_.send_reliable(*client_, replication::encode(message));
}

void FakeServer::send_garbage() {
    const std::vector<std::uint8_t> garbage{0xde, 0xad, 0xbe, 0xef, 0xff, 0xff, 0xff, 0x01};
    listener_.send_unreliable(*client_, garbage);
    listener_.send_reliable(*client_, garbage);
}

void FakeServer::kick(const std::string& detail) {
    listener_.disconnect(*client_, net::DisconnectReason::kKicked, detail);
}

}  // namespace fts::client
