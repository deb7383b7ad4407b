#include <algorithm>

#include "server/match/match_impl.h"
#include "server/match/spawn.h"

namespace fts::server {

using game::Phase;
using replication::LevelOutcome;

void Match::Impl::begin_phase(Phase next, double duration_s) {
    phase = next;
    phase_end = now + ticks_of(duration_s);
    log.add(replication::ArenaChange::phase_begun(event_tick(), phase, phase_end));
}

void Match::Impl::begin_level() {
    for (auto& [id, player] : players) {
        player.ball = 0;
        player.lives = game::kLivesPerLevel;
        player.spawn_tick = now;
        player.ready = false;
        player.coins_this_level = 0;
        player.strongest_hit.reset();
    }
    for (const auto& [id, ball] : balls) ball_ids.give_back(id, now);
    balls.clear();
    lives_of_leavers.clear();
    attribution.clear();
    memory.clear();
    audit_before = audit;
    arena.emplace(replication::course_of(level().platform, solver()),
                  std::span<const replication::BallState>());

    waiting_ai.clear();
    for (std::size_t group = 0; group < level().ai.size(); ++group)
        for (int i = 0; i < level().ai[group].count; ++i)
            waiting_ai.push_back({group, random.next()});
    for (int i = 0; i < level().field_coins; ++i) {
        constexpr double kCoinMarginM = 1.0;
        if (put_coin(scatter(level().platform, kCoinMarginM, random)))
            ledger.spawn_on_field(config.arena, 1);
    }
    begin_phase(Phase::kCountdown, game::kCountdownS);
    if (!players.empty()) tell_all(level_started());
    spawn_due();
    log.begin(event_tick());
}

void Match::Impl::end_level(LevelOutcome outcome) {
    cleared = outcome == LevelOutcome::kCleared || outcome == LevelOutcome::kCampaignComplete;
    ++(cleared ? totals.levels_cleared : totals.levels_lost);
    for (auto& [id, player] : players) {
        if (cleared) {
            ledger.award(player.key, game::kLevelClearCoins, Reason::kLevelClear);
            earn(id, game::kLevelClearCoins);
        }
        tell(id, replication::LevelEnded{level().number, outcome, player.coins_this_level});
    }
    clear_field();
    arena->halt();
    for (auto& [id, ball] : balls) ball.held = {};
    begin_phase(Phase::kShop, game::kShopS);
}

void Match::Impl::begin_next_level() {
    if (cleared) level_index = (level_index + 1) % config.levels.size();
    begin_level();
}

void Match::Impl::pause() {
    // Whoever comes next finds the level that the last player would have gone on to.
    if (phase == Phase::kShop && cleared) level_index = (level_index + 1) % config.levels.size();
    clear_field();
    for (const auto& [id, ball] : balls) ball_ids.give_back(id, now);
    balls.clear();
    waiting_ai.clear();
    hits.clear();
    lives_of_leavers.clear();
    outgoing.clear();
    arena.reset();
    log.begin(event_tick());
    phase = Phase::kWaiting;
    phase_end = 0;
}

bool Match::Impl::everybody_is_ready() const {
    return std::all_of(players.begin(), players.end(),
                       [](const auto& entry) { return entry.second.ready; });
}

}  // namespace fts::server
