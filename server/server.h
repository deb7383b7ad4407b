// Server: arenas, the clients that play in them, and the coins they earn. `tick` is the table of
// contents of what it does; time and sockets are passed in, the log is a function, the store runs
// on a thread of its own (journal.h). Everything else happens on the caller's thread, inside these
// calls.
//
// Clients are trusted with nothing but what they want to do: inputs are checked by sequence,
// rationed and applied one a tick; text is cleaned; purchases are the ledger's business and are
// answered only once they are durable. Whatever is refused, left out or dropped is counted by
// reason (`ServerReport::drops`).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/game/level.h"
#include "common/game/rules.h"
#include "common/net/connection.h"
#include "common/net/transport.h"
#include "common/physics/fidelity.h"
#include "common/physics/world.h"
#include "common/replication/messages.h"
#include "server/economy/journal.h"
#include "server/economy/ledger.h"
#include "server/economy/store.h"
#include "server/limits.h"
#include "server/log.h"
#include "server/match/match.h"
#include "server/session.h"
#include "server/snapshot_feed.h"
#include "server/stage_times.h"
#include "server/tick_clock.h"

namespace fts::server {

struct ServerConfig {
    std::string name = "Fear The Sphere";  // shown to players
    net::KeyPair key;
    std::vector<game::Level> levels;                        // at least one
    int arenas = 1;                                         // [1, kMaxArenas]
    int players_per_arena = game::kDefaultPlayersPerArena;  // [1, game::kMaxPlayersPerArena]
    int snapshot_rate_hz = game::kSnapshotRateHz;           // one of kSnapshotRatesHz
    int client_bytes_per_s = kDefaultClientBytesPerS;       // of snapshots, to each (limits.h)
    std::uint64_t seed = 1;                                 // arena i plays with seed + i
    JournalConfig journal;
    double tolerance = physics::kAutoTolerance;  // of collisions, as in common/physics/fidelity.h
    StageTimes::Clock stage_clock;               // empty: stages are not timed
};

struct ArenaReport {
    int arena = 0;
    int level = 0;
    std::vector<ScoreLine> scoreboard;
    MatchTotals totals;
    physics::CollisionAudit audit;
};

struct ServerReport {
    std::vector<ArenaReport> arenas;
    Totals coins;
    std::uint64_t ticks = 0;
    std::uint64_t clock_overruns = 0;  // times the server came so late that ticks were dropped
    std::uint64_t dropped_ticks = 0;
    std::uint64_t late_ticks = 0;    // made up for
    std::uint64_t player_ticks = 0;  // players in each tick, added up
    StageTimes::Histograms stages;   // empty ones without a stage clock
    std::uint64_t joins = 0;
    std::uint64_t store_failures = 0;
    std::size_t unwritten_transactions = 0;  // lost, because the store failed to the very end
    std::map<std::string, std::uint64_t> drops;
};

class Server {
  public:
    // The transport must outlive the server.
    Server(const ServerConfig& config, net::Transport& transport, std::unique_ptr<Store> store,
           Log log);
    ~Server();

    // Receives what has arrived and runs the ticks that are due; returns how many those were.
    int tick(double now_s);
    // When the next tick is due: sleep until then, or until a datagram arrives.
    double next_tick_s() const { return clock_.next_tick_s(); }

    std::size_t player_count() const;

    // Admits nobody any more, says goodbye to everybody, returns the coins on the platforms to the
    // mint and writes everything down. The end: only `report` may follow.
    void shut_down(double now_s, std::string_view goodbye);
    ServerReport report() const;

  private:
    struct Arena {
        Arena(const MatchConfig& config, Ledger& ledger)
            : number(config.arena), match(config, ledger) {}
        const int number;
        Match match;
        SnapshotFeed feed;
        std::map<PlayerId, Session*> players;  // of sessions_, from `admit` to `leave_match`
    };
    // A purchase that the player hears of once everything up to `sequence` is durable.
    struct Answer {
        std::uint64_t sequence = 0;
        net::ConnectionId connection = 0;
        PlayerId player = 0;
        replication::PurchaseResult result;
    };

    // server.cpp: the tick
    void receive(double now_s);
    void play_one_tick();
    void apply_inputs(Arena& arena);
    void deliver(Arena& arena);
    void note_level(const Arena& arena, const Outgoing& outgoing);
    class SnapshotLink;
    void publish_snapshot(Arena& arena);
    void send_snapshot(Arena& arena, Session& session);
    void settle_ledger(double now_s);
    void end_overdue_sessions(double now_s);
    void say_what_is_wrong(double now_s);

    // server_sessions.cpp: who comes and goes, and what they say
    void on(const net::Connected& event, double now_s);
    void on(const net::Disconnected& event, double now_s);
    void on(const net::ReliableMessage& event, double now_s);
    void on(const net::UnreliablePayload& event, double now_s);
    void handle(Session& session, const replication::JoinRequest& request, double now_s);
    void handle(Session& session, const replication::BuyRequest& request, double now_s);
    void handle(Session& session, const replication::ChatRequest& request, double now_s);
    void handle(Session& session, const replication::ReadyRequest& request, double now_s);
    void replace_older_sessions(const Session& newer);
    void admit(Session& session, const PlayerRecord& record, double now_s);
    std::optional<int> arena_with_room(int wanted) const;
    void refuse(Session& session, const std::string& reason, double now_s);
    void count_malformed(Session& session);
    void leave_match(Session& session);
    void kick(net::ConnectionId id, net::DisconnectReason reason, const std::string& detail);

    // server_ledger.cpp: coins between the match and the disk
    void hand_over_transactions();
    void admit_loaded(const std::vector<Journal::Loaded>& loaded, double now_s);
    void answer_purchases();
    void answer(net::ConnectionId connection, std::uint64_t request_id,
                replication::PurchaseOutcome outcome);
    void set_paused(bool paused);
    void note_journal_health(const Journal::State& state);

    Session* find(net::ConnectionId id);
    Session* find_ticket(std::uint64_t ticket);
    bool send(net::ConnectionId id, const replication::ServerMessage& message);
    bool send_encoded(net::ConnectionId id, std::span<const std::uint8_t> bytes);
    void count(std::string_view what, std::uint64_t times = 1) { drops_[what] += times; }

    const ServerConfig config_;
    const Log log_;
    Ledger ledger_;
    Journal journal_;
    net::Listener listener_;
    net::Transport& transport_;
    TickClock clock_{game::kTickDurationS};
    StageTimes stages_;
    std::vector<std::unique_ptr<Arena>> arenas_;
    std::map<net::ConnectionId, Session> sessions_;

    std::vector<Rename> renames_;  // not yet handed to the journal
    std::deque<Answer> answers_;   // by sequence
    std::uint64_t committed_up_to_ = 0;
    bool store_failing_ = false;
    bool paused_ = false;  // too many transactions wait to be written
    bool admitting_ = true;

    std::uint64_t ticks_ = 0;
    std::uint64_t player_ticks_ = 0;
    std::uint64_t joins_ = 0;
    std::uint64_t store_failures_ = 0;
    std::size_t unwritten_ = 0;
    std::optional<double> last_world_overrun_notice_s_;
    bool has_noticed_foreign_version_ = false;
    std::uint64_t world_overruns_ = 0, world_overruns_noticed_ = 0;
    std::map<std::string_view, std::uint64_t> drops_;
};

}  // namespace fts::server
