#include "client/core/arena_mirror.h"

#include <algorithm>
#include <cassert>

#include "client/core/end_words.h"

namespace fts::client {
namespace {

using replication::Snapshot;

constexpr std::size_t kLevelsKept = 2;
constexpr std::size_t kMaxLevelTextBytes = 200;

std::vector<replication::PlayerInfo> with_printable_names(
    std::vector<replication::PlayerInfo> players) {
    for (replication::PlayerInfo& player : players) {
        player.name = printable(player.name, game::kMaxNameBytes);
    }
    return players;
}

BallView ball_view(const BallPose& pose, std::uint16_t own_player_id,
                   const std::vector<replication::PlayerInfo>& players) {
    const replication::BallState& state = *pose.state;
    BallView ball;
    ball.id = state.id;
    ball.position_m = pose.position_m;
    ball.velocity_mps = pose.velocity_mps;
    ball.thrust = game::thrust_of({state.thrust_x, state.thrust_y});
    ball.radius_m = replication::dequantise(state.radius, replication::kRadiusStepM);
    ball.mass_kg = replication::dequantise(state.mass, replication::kMassStepKg);
    ball.is_player = state.kind == static_cast<std::uint8_t>(replication::BallKind::kPlayer);
    ball.braking = state.brake;
    ball.behaviour = static_cast<game::Behaviour>(state.behaviour);
    ball.player_id = state.player_id;
    ball.is_own = ball.is_player && own_player_id != 0 && state.player_id == own_player_id;
    const auto player =
        std::ranges::find(players, state.player_id, &replication::PlayerInfo::player_id);
    if (ball.is_player && player != players.end()) {
        ball.colour = player->colour;
        ball.name = player->name;
    }
    return ball;
}

}  // namespace

void ArenaMirror::apply(const replication::ServerMessage& message) {
    if (const auto* welcome = std::get_if<replication::Welcome>(&message)) {
        own_player_id_ = welcome->player_id;
        tick_rate_hz_ = welcome->tick_rate_hz;
        interpolation_.reset();
    } else if (const auto* level = std::get_if<replication::LevelStarted>(&message)) {
        levels_.push_back(*level);
        levels_.back().name = printable(level->name, kMaxLevelTextBytes);
        levels_.back().hint = printable(level->hint, kMaxLevelTextBytes);
        if (levels_.size() > kLevelsKept) levels_.pop_front();
    } else if (const auto* end = std::get_if<replication::LevelEnded>(&message)) {
        last_level_end_ = *end;
    } else if (const auto* roster = std::get_if<replication::Roster>(&message)) {
        players_ = with_printable_names(roster->players);
    } else if (const auto* wallet = std::get_if<replication::Wallet>(&message)) {
        wallet_ = *wallet;
    } else if (const auto* hit = std::get_if<replication::CollisionReport>(&message)) {
        last_own_hit_ = *hit;
    }
}

void ArenaMirror::add(std::shared_ptr<const Snapshot> snapshot,
                      std::vector<replication::ControlEvent> controls) {
    assert(snapshots_.empty() || snapshot->tick > newest_tick());
    for (const replication::HitState& hit : snapshot->hits) {
        if (pending_hits_.size() == kMaxPendingHits) {
            pending_hits_.pop_front();
            ++hits_dropped_count_;
        }
        pending_hits_.push_back(hit);
    }
    snapshots_.push_back(std::move(snapshot));
    controls_.push_back(std::move(controls));
    if (snapshots_.size() > kMaxHeldSnapshots) drop_oldest();
}

replication::Tick ArenaMirror::newest_tick() const {
    return snapshots_.empty() ? 0 : snapshots_.back()->tick;
}

const replication::LevelStarted* ArenaMirror::find_level(int number) const {
    const auto found = std::find_if(levels_.rbegin(), levels_.rend(),
                                    [&](const auto& level) { return level.number == number; });
    return found == levels_.rend() ? nullptr : &*found;
}

const replication::LevelStarted& ArenaMirror::level_numbered(int number) const {
    const replication::LevelStarted* const level = find_level(number);
    return level == nullptr ? levels_.back() : *level;
}

// A server's word; of a platform that makes no sense nothing is known.
std::optional<replication::Course> ArenaMirror::course_of(int number) const {
    const replication::LevelStarted* const level = find_level(number);
    if (level == nullptr) return std::nullopt;
    replication::Course course = replication::course_of(level->platform, level->solver);
    if (physics::validate(course.scene)) return std::nullopt;
    course.tick_s = 1.0 / tick_rate_hz_;
    return course;
}

View ArenaMirror::view_at(double server_time_s) {
    View view;
    view.own_player_id = own_player_id_;
    view.players = players_;
    view.coins_held = wallet_.coins;
    view.tiers = wallet_.tiers;
    view.last_level_end = last_level_end_;
    view.last_own_hit = last_own_hit_;
    if (!levels_.empty()) view.level = levels_.back();
    if (snapshots_.empty()) return view;

    view.server_time_s = server_time_s;
    const double draw_tick = server_time_s * tick_rate_hz_;
    drop_before(draw_tick);
    const Snapshot& shown = *snapshots_.front();
    view.phase = shown.phase;
    if (shown.phase_end_tick != 0) {
        view.phase_remaining_s = std::max(0.0, shown.phase_end_tick - draw_tick) / tick_rate_hz_;
    }
    if (!levels_.empty()) view.level = level_numbered(shown.level);
    for (const replication::CoinState& coin : shown.coins) {
        view.coins.push_back({coin.id, replication::place_m(coin.x, coin.y), coin.value_coins});
    }
    add_balls(view, draw_tick);
    add_hits(view, draw_tick);
    return view;
}

Glance ArenaMirror::glance_at(double server_time_s) {
    Glance glance;
    glance.tick_rate_hz = tick_rate_hz_;
    glance.own_player_id = own_player_id_;
    const auto own =
        std::ranges::find(players_, own_player_id_, &replication::PlayerInfo::player_id);
    if (own != players_.end()) glance.own_player = *own;
    glance.coins_held = wallet_.coins;
    glance.tiers = wallet_.tiers;
    if (snapshots_.empty()) return glance;

    const double draw_tick = server_time_s * tick_rate_hz_;
    drop_before(draw_tick);
    while (!pending_hits_.empty() && pending_hits_.front().tick <= draw_tick) {
        pending_hits_.pop_front();
    }
    glance.newest = snapshots_.back();
    if (const auto* level = find_level(glance.newest->level)) glance.platform = level->platform;
    return glance;
}

// Only the newest snapshot at or before a moment, and what comes after it, are still needed.
void ArenaMirror::drop_before(double draw_tick) {
    while (snapshots_.size() > 1 && snapshots_[1]->tick <= draw_tick) drop_oldest();
}

void ArenaMirror::drop_oldest() {
    snapshots_.pop_front();
    controls_.pop_front();
}

std::vector<BallPose> ArenaMirror::poses_at(double draw_tick) {
    const Snapshot& from = *snapshots_.front();
    const Snapshot& to = snapshots_.size() > 1 ? *snapshots_[1] : from;
    if (levels_.empty()) return interpolate(from, to, draw_tick, tick_rate_hz_);
    const int level = level_numbered(from.level).number;
    if (!interpolation_ || interpolated_level_ != level) {
        const auto course = course_of(level);
        if (!course) return interpolate(from, to, draw_tick, tick_rate_hz_);
        interpolation_.emplace(*course);
        interpolated_level_ = level;
    }
    return interpolation_->at(from, to, controls_[snapshots_.size() > 1 ? 1 : 0], draw_tick);
}

void ArenaMirror::add_balls(View& view, double draw_tick) {
    for (const BallPose& pose : poses_at(draw_tick)) {
        BallView ball = ball_view(pose, own_player_id_, players_);
        if (ball.is_own) view.own_ball = view.balls.size();
        view.balls.push_back(std::move(ball));
    }
}

void ArenaMirror::add_hits(View& view, double draw_tick) {
    while (!pending_hits_.empty() && pending_hits_.front().tick <= draw_tick) {
        const replication::HitState& hit = pending_hits_.front();
        view.hits.push_back({replication::place_m(hit.x, hit.y),
                             replication::dequantise(hit.impulse, replication::kImpulseStepNs),
                             hit.a, hit.b});
        pending_hits_.pop_front();
    }
}

}  // namespace fts::client
