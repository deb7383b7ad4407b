// What a match says: messages, the briefing and the snapshot.
#include <algorithm>
#include <limits>

#include "server/match/match_impl.h"

namespace fts::server {
namespace {

bool same(const replication::PlayerInfo& a, const replication::PlayerInfo& b) {
    return a.player_id == b.player_id && a.name == b.name && a.colour == b.colour &&
           a.knock_offs == b.knock_offs && a.assists == b.assists && a.falls == b.falls &&
           a.lives == b.lives && a.coins == b.coins && a.ready == b.ready;
}

bool same(const replication::Wallet& a, const replication::Wallet& b) {
    return a.coins == b.coins && a.tiers == b.tiers;
}

int shown(std::int64_t coins) {
    return static_cast<int>(std::min<std::int64_t>(coins, std::numeric_limits<int>::max()));
}

}  // namespace

void Match::Impl::tell(PlayerId player, replication::ServerMessage message) {
    outgoing.push_back({player, std::move(message)});
}

void Match::Impl::tell_all(replication::ServerMessage message) {
    outgoing.push_back({std::nullopt, std::move(message)});
}

void Match::Impl::send_due() {
    const bool coins_moved = told_sequence != ledger.last_sequence();
    told_sequence = ledger.last_sequence();
    for (auto& [id, player] : players) {
        if (coins_moved || !player.told_wallet) {
            const replication::Wallet wallet = wallet_of(player);
            if (!player.told_wallet || !same(*player.told_wallet, wallet)) tell(id, wallet);
            player.told_wallet = wallet;
        }
        if (player.strongest_hit && now >= player.next_report_tick) {
            tell(id, *player.strongest_hit);
            player.strongest_hit.reset();
            player.next_report_tick = now + kReportIntervalTicks;
        }
    }
    if (now < next_roster_tick) return;
    next_roster_tick = now + kRosterIntervalTicks;
    replication::Roster present = roster();
    const auto& told = told_roster.players;
    const bool unchanged =
        std::equal(present.players.begin(), present.players.end(), told.begin(), told.end(),
                   [](const auto& a, const auto& b) { return same(a, b); });
    if (unchanged) return;
    told_roster = present;
    tell_all(std::move(present));
}

void Match::Impl::report_hit(std::uint16_t own, std::uint16_t other,
                             const physics::Contact<double>& contact, bool own_is_a) {
    Player& player = players.at(balls.at(own).player);
    if (player.strongest_hit) {
        ++totals.reports_left_out;
        if (player.strongest_hit->impulse_ns >= contact.impulse_ns) return;
    }
    replication::CollisionReport::Side a{.ball = own_is_a ? own : other,
                                         .player_id = 0,
                                         .mass_kg = contact.mass_a_kg,
                                         .radius_m = 0.0,
                                         .position_m = contact.position_a_m,
                                         .velocity_before_mps = contact.velocity_a_before_mps,
                                         .velocity_after_mps = contact.velocity_a_after_mps};
    replication::CollisionReport::Side b{.ball = own_is_a ? other : own,
                                         .player_id = 0,
                                         .mass_kg = contact.mass_b_kg,
                                         .radius_m = 0.0,
                                         .position_m = contact.position_b_m,
                                         .velocity_before_mps = contact.velocity_b_before_mps,
                                         .velocity_after_mps = contact.velocity_b_after_mps};
    for (auto* side : {&a, &b}) {
        side->player_id = balls.at(side->ball).player;
        side->radius_m = balls.at(side->ball).stats.radius_m;
    }
    player.strongest_hit = {.tick = now,
                            .time_in_tick_s = contact.time_s,
                            .own = own_is_a ? a : b,
                            .other = own_is_a ? b : a,
                            .normal = own_is_a ? contact.normal : -contact.normal,
                            .impulse_ns = contact.impulse_ns,
                            .contacts_at_once = contact.contacts_at_once};
}

replication::LevelStarted Match::Impl::level_started() const {
    int ai_balls = 0;
    for (const game::AiGroup& group : level().ai) ai_balls += group.count;
    return {.number = level().number,
            .level_count = static_cast<int>(config.levels.size()),
            .name = level().name,
            .hint = level().hint,
            .platform = level().platform,
            .ai_balls = ai_balls,
            .solver = solver()};
}

replication::Roster Match::Impl::roster() const {
    replication::Roster result;
    for (const auto& [id, player] : players) {
        const ScoreLine& line = scores.at(player.key);
        result.players.push_back({.player_id = id,
                                  .name = player.name,
                                  .colour = static_cast<std::uint8_t>((id - 1) % kPaletteColours),
                                  .knock_offs = line.knock_offs,
                                  .assists = line.assists,
                                  .falls = line.falls,
                                  .lives = player.lives,
                                  .coins = shown(ledger.coins(player.key)),
                                  .ready = player.ready});
    }
    return result;
}

replication::Wallet Match::Impl::wallet_of(const Player& player) const {
    return {shown(ledger.coins(player.key)), ledger.tiers(player.key)};
}

std::vector<replication::ServerMessage> Match::briefing(PlayerId id) const {
    const auto found = impl_->players.find(id);
    if (found == impl_->players.end()) return {};
    return {impl_->level_started(), impl_->roster(), impl_->wallet_of(found->second)};
}

replication::Snapshot Match::snapshot() const {
    const Impl& match = *impl_;
    replication::Snapshot result;
    result.tick = match.now;
    result.arena = static_cast<std::uint8_t>(match.config.arena);
    result.phase = match.phase;
    result.level = static_cast<std::uint16_t>(match.level().number);
    result.phase_end_tick = match.phase_end;
    if (match.arena) result.balls = match.arena->balls();
    for (const auto& [id, coin] : match.coins) result.coins.push_back(match.state_of(id, coin));
    result.hits = match.hits.sorted();
    return result;
}

}  // namespace fts::server
