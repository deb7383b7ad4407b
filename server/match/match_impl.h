// The inside of a match, shared by match*.cpp only.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/game/movement.h"
#include "common/game/rules.h"
#include "common/replication/hit_log.h"
#include "common/replication/lattice_world.h"
#include "server/ai/perception.h"
#include "server/ai/pilot.h"
#include "server/match/attribution.h"
#include "server/match/event_log.h"
#include "server/match/id_pool.h"
#include "server/match/match.h"
#include "server/match/random.h"

namespace fts::server {

using replication::Tick;

constexpr Tick ticks_of(double duration_s) {
    return static_cast<Tick>(duration_s * game::kTickRateHz + 0.5);
}

inline constexpr std::size_t kMaxFieldCoins = 256;
// A level's AI balls come in over several ticks, so that none of these lasts long: what a ball's
// place costs grows with the balls that are there.
inline constexpr std::size_t kMaxAiPlacedInTick = 32;
inline constexpr std::size_t kMaxScoreLines = 1024;
static_assert(kMaxScoreLines > game::kMaxPlayersPerArena);
inline constexpr std::uint8_t kPaletteColours = 8;
inline constexpr Tick kIdRestTicks = ticks_of(10.0);
// A player is told of at most 10 hits a second: the strongest of each interval.
inline constexpr Tick kReportIntervalTicks = game::kTickRateHz / 10;
inline constexpr Tick kRosterIntervalTicks = game::kTickRateHz / 5;

struct Match::Impl {
    struct Ball {
        PlayerId player = 0;  // 0: an AI ball
        game::BallStats stats;
        game::InputCommand input;
        game::InputCommand held;  // what acts on it
        game::DashState dash;
        game::Behaviour behaviour = game::Behaviour::kChaser;
        std::optional<ai::Pilot> pilot;  // of an AI ball
    };
    struct Player {
        PlayerKey key{};
        std::string name;
        game::InputCommand input;
        int lives = 0;
        bool ready = false;
        std::uint16_t ball = 0;  // 0: not on the platform
        Tick spawn_tick = 0;     // not before this tick, without a ball and with lives left
        int coins_this_level = 0;
        std::optional<replication::Wallet> told_wallet;
        std::optional<replication::CollisionReport> strongest_hit;
        Tick next_report_tick = 0;
    };
    struct Coin {
        physics::Vec2d position_m;
        int value_coins = 1;
    };
    // An AI ball of the level that has not found its place yet.
    struct Waiting {
        std::size_t group = 0;
        std::uint64_t seed = 0;
    };

    Impl(const MatchConfig& match_config, Ledger& match_ledger);

    // The tick whose snapshot is the first to show what happens now.
    Tick event_tick() const { return in_tick ? now : now + 1; }
    physics::BodyView<double> body(std::uint16_t ball) const { return arena->body(ball); }
    replication::BallState state_of(std::uint16_t id, const Ball& ball,
                                    const physics::Vec2d& position_m) const;
    replication::CoinState state_of(std::uint16_t id, const Coin& coin) const;
    physics::SolverChoice solver() const {
        return config.solvers.empty() ? physics::SolverChoice() : config.solvers[level_index];
    }

    const game::Level& level() const { return config.levels[level_index]; }
    static Actor actor_of(std::uint16_t id, const Ball& ball);
    ScoreLine& score(PlayerId id) { return scores.at(players.at(id).key); }
    void begin_score(PlayerId id, const Player& player);
    void earn(PlayerId id, int earned);

    // match_phases.cpp
    void begin_level();
    void begin_phase(game::Phase next, double duration_s);
    void end_level(replication::LevelOutcome outcome);
    void begin_next_level();
    void pause();
    bool everybody_is_ready() const;

    // match_placing.cpp
    void spawn_due();
    bool spawn_ai(const Waiting& waiting);
    bool spawn_player(PlayerId id, Player& player);
    std::optional<std::uint16_t> place_ball(Ball ball);
    void remove_ball(std::uint16_t id);
    void forget_coin(std::uint16_t id);
    // What travels is rounded; a ball is what travels.
    static void settle_on_lattice(game::BallStats& stats);
    bool put_coin(const physics::Vec2d& position_m);
    void drop_coins(PlayerId id, const physics::Vec2d& fallen_at_m);
    void clear_field();

    // match_play.cpp: the stages of a tick of play
    TickFacts play_tick();
    void think();
    void apply_controls();
    TickFacts step_world();
    void snap();
    void record_contacts();
    void settle_falls();
    void settle_fall(std::uint16_t ball_id, const physics::Vec2d& fallen_at_m,
                     const std::vector<Attribution::Share>& shares);
    void collect_coins();
    void judge_level();
    void remember();

    // match_messages.cpp
    void tell(PlayerId player, replication::ServerMessage message);
    void tell_all(replication::ServerMessage message);
    void send_due();
    // `own` is a player's.
    void report_hit(std::uint16_t own, std::uint16_t other, const physics::Contact<double>& contact,
                    bool own_is_a);
    replication::LevelStarted level_started() const;
    replication::Roster roster() const;
    replication::Wallet wallet_of(const Player& player) const;

    MatchConfig config;
    Ledger& ledger;
    Random random;
    IdPool ball_ids{kIdRestTicks};
    IdPool coin_ids{kIdRestTicks};

    Tick now = 0;
    game::Phase phase = game::Phase::kWaiting;
    Tick phase_end = 0;
    std::size_t level_index = 0;
    bool cleared = false;  // the level whose shop is open

    bool in_tick = false;
    // Of the present level; empty while the arena is paused.
    std::optional<replication::LatticeWorld> arena;
    EventLog log;  // of what is done to it from outside, and to phase and coins
    std::map<std::uint16_t, Ball> balls;
    std::vector<Waiting> waiting_ai;
    Tick ai_tried_in = 0;      // the tick in which ...
    std::size_t ai_tried = 0;  // ... so many were given a try
    std::map<std::uint16_t, Coin> coins;
    Attribution attribution;
    ai::Memory memory;
    replication::HitLog hits;

    PlayerId last_player = 0;
    std::map<PlayerId, Player> players;
    std::map<PlayerKey, int> lives_of_leavers;  // in this level: coming back does not renew them
    std::map<PlayerKey, ScoreLine> scores;  // of players and those who left, at most kMaxScoreLines

    replication::Roster told_roster;
    Tick next_roster_tick = 0;
    std::uint64_t told_sequence = 0;  // of the ledger, when wallets were last looked at
    std::vector<Outgoing> outgoing;

    MatchTotals totals;
    physics::CollisionAudit audit_before;  // of the worlds before the last snap
    physics::CollisionAudit audit;
};

}  // namespace fts::server
