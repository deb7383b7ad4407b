// A match on a bench: some players with their records, levels made on the spot, and what it said.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "server/match/match.h"

namespace fts::server {

PlayerKey key_of(int number);
std::uint64_t hash_of(const replication::Snapshot& snapshot);

// A level whose AI balls cannot move by themselves.
game::Level quiet_level(int number, const physics::Platform& platform, int ai_balls = 1);

class MatchBench {
  public:
    explicit MatchBench(std::vector<game::Level> levels, std::uint64_t seed = 1,
                        int max_players = game::kDefaultPlayersPerArena);

    // Loads the record when it is not loaded yet, and joins.
    PlayerId join(int number, std::int64_t coins = 0);
    // Ticks and keeps what was said since the call.
    void tick(int count = 1);
    void tick_until(game::Phase phase, int limit = 60 * 600);

    std::optional<replication::BallState> ball_of(PlayerId player) const;
    ScoreLine score_of(PlayerId player) const;

    template <typename Message>
    std::vector<Message> said(std::optional<PlayerId> to = std::nullopt) const {
        std::vector<Message> result;
        for (const Outgoing& outgoing : said_)
            if (const auto* message = std::get_if<Message>(&outgoing.message))
                if (outgoing.to == to) result.push_back(*message);
        return result;
    }

    Ledger ledger;
    Match match;

  private:
    std::vector<Outgoing> said_;
};

// Straight at the nearest AI ball, or anybody, without a thought for the edge.
enum class Prey { kAi, kAnybody };
game::InputCommand ram(const replication::Snapshot& snapshot, PlayerId player, Prey prey);

}  // namespace fts::server
