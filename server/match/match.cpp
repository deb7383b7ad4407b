#include "server/match/match.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "server/match/match_impl.h"

namespace fts::server {
namespace {

using replication::ArenaChange;

// At most `max_bytes`, without cutting a UTF-8 sequence in two.
std::string cut(const std::string& text, std::size_t max_bytes) {
    if (text.size() <= max_bytes) return text;
    std::size_t end = max_bytes;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return text.substr(0, end);
}

}  // namespace

Match::Impl::Impl(const MatchConfig& match_config, Ledger& match_ledger)
    : config(match_config), ledger(match_ledger), random(match_config.seed) {
    assert(!config.levels.empty());
    assert(config.solvers.empty() || config.solvers.size() == config.levels.size());
    assert(config.max_players > 0 && config.max_players <= game::kMaxPlayersPerArena);
}

Match::Match(const MatchConfig& config, Ledger& ledger)
    : impl_(std::make_unique<Impl>(config, ledger)) {}

Match::~Match() = default;

bool Match::has_room() const {
    return impl_->players.size() < static_cast<std::size_t>(impl_->config.max_players);
}

std::optional<PlayerId> Match::join(const PlayerKey& key, const std::string& name) {
    if (!has_room()) return std::nullopt;
    Impl& match = *impl_;
    assert(match.ledger.is_loaded(key));
    if (match.phase == game::Phase::kWaiting) match.begin_level();

    do {
        ++match.last_player;
    } while (match.last_player == 0 || match.players.contains(match.last_player));
    const PlayerId id = match.last_player;
    const auto known = match.lives_of_leavers.find(key);
    Impl::Player player;
    player.key = key;
    player.name = name;
    player.lives = known == match.lives_of_leavers.end() ? game::kLivesPerLevel : known->second;
    match.begin_score(id, player);
    match.players.emplace(id, std::move(player));
    match.spawn_due();
    return id;
}

// Who comes back goes on with the old score. When the board is full, the weakest line of somebody
// who is not here makes room.
void Match::Impl::begin_score(PlayerId id, const Player& player) {
    if (scores.size() >= kMaxScoreLines && !scores.contains(player.key)) {
        const auto is_here = [this](const PlayerKey& key) {
            return std::ranges::any_of(players,
                                       [&](const auto& entry) { return entry.second.key == key; });
        };
        auto weakest = scores.end();
        for (auto line = scores.begin(); line != scores.end(); ++line) {
            if (is_here(line->first)) continue;
            if (weakest == scores.end() ||
                line->second.coins_earned < weakest->second.coins_earned) {
                weakest = line;
            }
        }
        scores.erase(weakest);
        ++totals.scores_forgotten;
    }
    ScoreLine& line = scores[player.key];
    line.player = id;
    line.name = player.name;
}

void Match::leave(PlayerId id) {
    Impl& match = *impl_;
    const auto found = match.players.find(id);
    if (found == match.players.end()) return;
    match.lives_of_leavers[found->second.key] = found->second.lives;
    if (found->second.ball != 0) match.remove_ball(found->second.ball);
    match.players.erase(found);
    std::erase_if(match.outgoing, [id](const Outgoing& message) { return message.to == id; });
    if (match.players.empty()) match.pause();
}

std::size_t Match::player_count() const {
    return impl_->players.size();
}

void Match::set_input(PlayerId id, const game::InputCommand& input) {
    const auto found = impl_->players.find(id);
    if (found != impl_->players.end()) found->second.input = input;
}

void Match::set_ready(PlayerId id) {
    const auto found = impl_->players.find(id);
    if (found != impl_->players.end() && impl_->phase == game::Phase::kShop)
        found->second.ready = true;
}

void Match::chat(PlayerId id, const std::string& text) {
    if (text.empty() || !impl_->players.contains(id)) return;
    impl_->tell_all(replication::ChatLine{id, cut(text, game::kMaxChatBytes)});
}

bool Match::shop_is_open() const {
    return impl_->phase == game::Phase::kShop;
}

void Match::upgrades_changed(PlayerId id) {
    const auto found = impl_->players.find(id);
    if (found == impl_->players.end() || found->second.ball == 0) return;
    Impl::Ball& ball = impl_->balls.at(found->second.ball);
    ball.stats = game::stats_for(impl_->ledger.tiers(found->second.key));
    impl_->settle_on_lattice(ball.stats);
    const std::uint16_t ball_id = found->second.ball;
    const replication::BallState state =
        impl_->state_of(ball_id, ball, impl_->body(ball_id).position_m);
    impl_->arena->put(state);
    impl_->log.add(ArenaChange::ball_put(impl_->event_tick(), state));
}

TickFacts Match::tick() {
    Impl& match = *impl_;
    if (match.phase == game::Phase::kWaiting) return {};
    match.in_tick = true;
    ++match.now;
    ++match.totals.ticks;
    TickFacts facts;
    switch (match.phase) {
        case game::Phase::kWaiting:
            break;
        case game::Phase::kCountdown:
            match.spawn_due();
            if (match.now >= match.phase_end)
                match.begin_phase(game::Phase::kPlaying, match.level().time_limit_s);
            break;
        case game::Phase::kPlaying:
            facts = match.play_tick();
            break;
        case game::Phase::kShop:
            if (match.now >= match.phase_end || match.everybody_is_ready())
                match.begin_next_level();
            break;
    }
    match.send_due();
    if (match.arena && snapshot_is_due()) match.snap();
    match.in_tick = false;
    return facts;
}

bool Match::snapshot_is_due() const {
    return (impl_->now + static_cast<replication::Tick>(impl_->config.arena)) %
               impl_->config.snapshot_ticks ==
           0;
}

void Match::clear_hits() {
    impl_->hits.clear();
}

const EventLog& Match::events() const {
    return impl_->log;
}

std::vector<Outgoing> Match::drain_outgoing() {
    return std::exchange(impl_->outgoing, {});
}

game::Phase Match::phase() const {
    return impl_->phase;
}

int Match::level_number() const {
    return impl_->level().number;
}

std::vector<ScoreLine> Match::scoreboard() const {
    std::vector<ScoreLine> lines;
    for (const auto& [key, line] : impl_->scores) lines.push_back(line);
    std::stable_sort(lines.begin(), lines.end(), [](const ScoreLine& a, const ScoreLine& b) {
        if (a.knock_offs != b.knock_offs) return a.knock_offs > b.knock_offs;
        if (a.coins_earned != b.coins_earned) return a.coins_earned > b.coins_earned;
        return a.falls < b.falls;
    });
    return lines;
}

MatchTotals Match::totals() const {
    MatchTotals totals = impl_->totals;
    totals.hits_left_out = impl_->hits.left_out();
    totals.contacts_forgotten = impl_->attribution.contacts_forgotten_early();
    return totals;
}

const physics::CollisionAudit& Match::audit() const {
    return impl_->audit;
}

}  // namespace fts::server
