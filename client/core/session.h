// Session: one player's connection to a server, without a window. It owns the dialer, the snapshot
// history and the server clock, and answers one question: what is to be seen now (`view`).
//
// Time is passed in, seconds of any monotonic clock. Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/core/glance.h"
#include "client/core/view.h"
#include "common/game/input.h"
#include "common/net/connection.h"
#include "common/net/transport.h"
#include "common/replication/messages.h"
#include "common/replication/shared_replay.h"

namespace fts::client {

struct SessionConfig {
    std::string name = "player";
    net::KeyPair key;
    net::Address server;
    int arena = -1;
    std::optional<net::PublicKey> pinned_server_key;
    std::uint16_t protocol_version = net::kProtocolVersion;
    // With whom replays are shared: sessions of this process with the same server. Null: nobody.
    std::shared_ptr<replication::SharedReplay> replays;
    // Runs the own ball ahead of the server's snapshots (own_ball_prediction.h).
    bool predicts_own_ball = false;
};

enum class Status : std::uint8_t { kConnecting, kJoining, kPlaying, kEnded };

inline constexpr std::size_t kMaxPendingNotices = 1024;

// Things that happened, for a screen to show or a script to expect, in order.
struct Notice {
    enum class Kind : std::uint8_t {
        kLevelStarted,
        kLevelEnded,
        kKnockOff,
        kPurchase,
        kChat,
        kOwnHit,
    };
    Kind kind = Kind::kChat;
    replication::ServerMessage message;
};

struct SessionStats {
    std::uint64_t snapshots_received = 0;  // whole ones
    std::uint64_t snapshots_sketched = 0;  // of which some balls were told, and the rest guessed
    std::uint64_t snapshots_missed = 0;    // by tick numbers that never came in time
    std::uint64_t snapshots_late = 0;      // of the missed: parts that came after a newer snapshot
    std::uint64_t snapshots_malformed = 0;
    std::uint64_t snapshots_unlike = 0;  // replayed to another state than the server's
    std::uint64_t messages_malformed = 0;
    std::uint64_t messages_unsent = 0;  // too long, or more than the channel holds
    std::uint64_t frames = 0;           // views made while playing
    std::uint64_t frames_starved = 0;
    std::uint64_t inputs_sent = 0;      // each once, however often repeated
    std::uint64_t inputs_given_up = 0;  // not acknowledged within kMaxInputsPerPacket ticks
    std::uint64_t inputs_skipped = 0;   // ticks not answered: `update` was called too rarely
    std::uint64_t inputs_late = 0;      // snapshots that say that a tick found no input waiting
    std::uint64_t notices_dropped = 0;  // more than kMaxPendingNotices between two drains
    std::uint64_t hits_dropped = 0;     // more than kMaxPendingHits before a view was made
    std::uint64_t delay_limited = 0;    // arrivals too late for the longest interpolation delay
    std::uint64_t clock_steps = 0;      // times the moment drawn stepped ahead
    net::LinkStats link;
};

class Session {
  public:
    // The transport must outlive the session.
    Session(const SessionConfig& config, net::Transport& transport);
    ~Session();

    // Receives what has arrived, sends inputs that are due. Call at least once per frame.
    void update(double now_s);

    // Whether views show the own ball where it is predicted to be, if it is predicted; at first,
    // yes.
    void show_prediction(bool shown);
    // Held until the next call.
    void set_input(const game::InputCommand& input);
    // Returns the request id. The result comes as a Notice.
    std::uint64_t buy(game::Stat stat);
    void chat(const std::string& text);
    void ready();
    void leave(double now_s);

    Status status() const;
    // Why it ended, in words for a person, with a remedy: "No answer from 10.0.0.1:7777. Is the
    // server running, and UDP port 7777 open?"
    const std::string& ended_because() const;
    net::DisconnectReason end_reason() const;
    // Known once connected; the caller pins it.
    std::optional<net::PublicKey> server_key() const;

    // Either is a frame of the statistics.
    View view(double now_s);
    Glance glance(double now_s);
    std::vector<Notice> drain_notices();
    SessionStats stats() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fts::client
