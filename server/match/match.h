// Match: the authoritative game of one arena. Owns the physics world, AI balls, attribution, lives
// and the phases of the campaign; knows no socket, no byte and no clock. A tick is one call.
//
// Given the same levels, seed and calls in the same ticks, a match gives the same bits. Not
// thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/game/input.h"
#include "common/game/level.h"
#include "common/game/rules.h"
#include "common/physics/world.h"
#include "common/replication/messages.h"
#include "common/replication/snapshot.h"
#include "server/economy/ledger.h"
#include "server/match/event_log.h"

namespace fts::server {

using PlayerId = std::uint16_t;  // 1, 2, 3, ...; unique among the players who are here

struct MatchConfig {
    int arena = 0;
    std::uint64_t seed = 1;
    std::vector<game::Level> levels;  // at least one, numbered 1, 2, 3, ...
    int max_players = game::kDefaultPlayersPerArena;
    std::vector<physics::SolverChoice> solvers;  // one a level, or none: swept
    replication::Tick snapshot_ticks = game::kTickRateHz / game::kSnapshotRateHz;
};

// A message for one player, or for all in the arena when `to` is empty.
struct Outgoing {
    std::optional<PlayerId> to;
    replication::ServerMessage message;
};

struct ScoreLine {
    PlayerId player = 0;
    std::string name;
    int knock_offs = 0, assists = 0, falls = 0;
    std::int64_t coins_earned = 0;   // awarded and picked up
    std::int64_t coins_dropped = 0;  // by falling
};

struct MatchTotals {
    std::uint64_t ticks = 0;          // simulated, pauses not counted
    std::uint64_t overruns = 0;       // ticks whose event budget ran out (world.h)
    std::uint64_t ai_knock_offs = 0;  // AI balls that fell
    int levels_cleared = 0, levels_lost = 0;
    // Limits that were reached.
    std::uint64_t spawns_delayed = 0;    // ticks in which a ball found no free spot and had to wait
    std::uint64_t hits_left_out = 0;     // of snapshots (hit_log.h)
    std::uint64_t reports_left_out = 0;  // collisions too soon after a stronger one to be reported
    std::uint64_t contacts_forgotten = 0;  // early, by attribution (attribution.h)
    std::uint64_t drops_refused = 0;     // coins that stayed in a purse because the field was full
    std::uint64_t scores_forgotten = 0;  // lines of leavers that made room on the scoreboard
};

// What a tick has to say to the log of the server.
struct TickFacts {
    bool overrun = false;         // the world's event budget ran out ...
    double unspent_time_s = 0.0;  // ... and this much of the tick was not simulated
};

class Match {
  public:
    // The ledger must outlive the match.
    Match(const MatchConfig& config, Ledger& ledger);
    ~Match();

    bool has_room() const;
    // The player's record must be loaded in the ledger, and stay so until `leave`. Empty when the
    // arena is full. A ball is placed at once when the level is on, else at the start of the next
    // one.
    std::optional<PlayerId> join(const PlayerKey& key, const std::string& name);
    void leave(PlayerId player);
    std::size_t player_count() const;

    // The command acts from the next tick on, until another one comes.
    void set_input(PlayerId player, const game::InputCommand& input);
    void set_ready(PlayerId player);
    void chat(PlayerId player, const std::string& text);  // cut to kMaxChatBytes
    // Whether the shop is open to this player now.
    bool shop_is_open() const;
    // The ledger's tiers of this player have changed: the ball takes them on now.
    void upgrades_changed(PlayerId player);

    // One sixtieth of a second; nothing happens while nobody is here.
    TickFacts tick();

    // Whether the state was put on the lattice at the end of this tick: its snapshot is one from
    // which, with `events`, everything that follows can be replayed.
    bool snapshot_is_due() const;
    replication::Snapshot snapshot() const;  // hits: all since the last call of `clear_hits`
    const EventLog& events() const;
    void clear_hits();
    std::vector<Outgoing> drain_outgoing();

    // What a player who has just joined must be told of the present: level, roster, wallet.
    std::vector<replication::ServerMessage> briefing(PlayerId player) const;

    game::Phase phase() const;
    int level_number() const;
    std::vector<ScoreLine> scoreboard() const;  // of everybody who ever played here, best first
    MatchTotals totals() const;
    const physics::CollisionAudit& audit() const;  // over all levels of this match

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fts::server
