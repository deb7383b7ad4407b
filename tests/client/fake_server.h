// A server without a game: it lets one client in over memory, sends it snapshots of one ball in
// straight flight, and writes down every input that it applies.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/net/connection.h"
#include "common/replication/messages.h"
#include "common/replication/snapshot_history.h"
#include "tests/net/memory_network.h"

namespace fts::client {

class FakeServer {
  public:
    FakeServer(net::MemoryNetwork& network, const net::ListenerConfig& config);

    static net::Address address() { return net::address_of(1); }
    const net::KeyPair& key() const { return key_; }

    // Once per tick of 60 Hz.
    void tick(double now_s);
    void send(const replication::ServerMessage& message);
    // Leaves one snapshot out of the stream without ever sending it.
    void skip_next_snapshot() { skip_next_ = true; }
    void send_garbage();
    void kick(const std::string& detail);
    void close() { listener_.close("closing time"); }

    // The position of the ball at a server time.
    static physics::Vec2d ball_at_m(double server_s);

    bool refuse_everybody = false;
    game::Phase phase = game::Phase::kPlaying;
    replication::Welcome welcome{9, 0, 60, 30, "fake"};
    std::vector<game::InputCommand> applied;  // in the order applied
    std::uint32_t last_applied = 0;
    std::uint8_t input_slack = 4;      // as each snapshot says it: a quarter of a tick
    std::uint32_t sequences_lost = 0;  // gaps that no packet repeated
    std::set<replication::Tick> acked_ticks;
    std::set<replication::Tick> sent_ticks;
    std::uint64_t keyframes_sent = 0, deltas_sent = 0;
    std::vector<replication::ClientMessage> received;
    std::optional<net::Disconnected> disconnected;
    replication::Tick now_tick = 1000;

  private:
    void handle(const net::Event& event);
    void take_inputs(const replication::InputPacket& packet);
    void send_snapshot();

    net::KeyPair key_;
    net::MemoryTransport transport_;
    net::Listener listener_;
    std::optional<net::ConnectionId> client_;
    bool joined_ = false;
    bool skip_next_ = false;
    replication::SnapshotHistory history_;
    replication::Tick newest_acked_ = 0;
};

}  // namespace fts::client
