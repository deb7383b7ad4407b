// Match: the authoritative game of one arena. Owns the physics world, AI balls, attribution, lives and
// the phases of the campaign; knows no socket, no byte and no clock. A tick is one call.
//
// Given the same levels, seed and calls in the same ticks, a match gives the same bits. Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/game/input.h"
#include "common/game/level.h"
#include "common/physics/world.h"
#include "common/replication/messages.h"
#include "common/replication/snapshot.h"
#include "server/economy/ledger.h"

namespace fts::server {

using PlayerId = std::uint16_t;  // 1, 2, 3, ...; unique within the match, never reused

struct MatchConfig {
    int arena = 0;
    std::uint64_t seed = 1;
    std::vector<game::Level> levels;  // at least one, numbered 1, 2, 3, ...
    int max_players = game::kDefaultPlayersPerArena;
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
    std::int64_t coins_earned = 0;
};

struct MatchTotals {
    std::uint64_t ticks = 0;          // simulated, pauses not counted
    std::uint64_t overruns = 0;       // ticks whose event budget ran out (world.h)
    std::uint64_t ai_knock_offs = 0;  // AI balls that fell
    int levels_cleared = 0, levels_lost = 0;
};

class Match {
  public:
    // The ledger must outlive the match.
    Match(const MatchConfig& config, Ledger& ledger);
    ~Match();

    bool has_room() const;
    // The player's record must be loaded in the ledger. Empty when the arena is full.
    std::optional<PlayerId> join(const PlayerKey& key, const std::string& name);
    void leave(PlayerId player);
    std::size_t player_count() const;

    // The command acts from the next tick on, until another one comes.
    void set_input(PlayerId player, const game::InputCommand& input);
    void set_ready(PlayerId player);
    void chat(PlayerId player, const std::string& text);
    // Whether the shop is open to this player now.
    bool shop_is_open() const;
    // The ledger's tiers of this player have changed: the ball takes them on now.
    void upgrades_changed(PlayerId player);

    void tick();

    replication::Snapshot snapshot() const;  // hits: all since the last call of `clear_hits`
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
