#include <algorithm>
#include <cmath>

#include "common/replication/snapshot_codec.h"
#include "server/match/match_impl.h"
#include "server/match/spawn.h"

namespace fts::server {

using physics::Vec2d;
using replication::LevelOutcome;

TickFacts Match::Impl::play_tick() {
    spawn_due();
    think();
    apply_controls();
    const TickFacts facts = step_world();
    record_contacts();
    settle_falls();
    collect_coins();
    remember();
    judge_level();
    return facts;
}

void Match::Impl::think() {
    for (auto& [id, ball] : balls) {
        if (ball.pilot)
            ball.input = ball.pilot->command(id, ball.stats, level().platform, memory);
        else
            ball.input = players.at(ball.player).input;
    }
}

void Match::Impl::apply_controls() {
    for (auto& [id, ball] : balls) {
        const game::InputCommand& wanted = ball.input;
        const bool dashes = game::advance_dash(ball.dash, ball.stats, wanted, game::kTickRateHz);
        const game::InputCommand steering{wanted.thrust_x, wanted.thrust_y, wanted.brake};
        if (steering == ball.held && !dashes) continue;
        ball.held = steering;
        const std::size_t slot = arena->slot_of(id).value();
        arena->steer(
            slot,
            {.thrust_x = wanted.thrust_x, .thrust_y = wanted.thrust_y, .brake = wanted.brake});
        if (dashes) arena->dash(slot);
        log.add(replication::ControlEvent{now, id, wanted.thrust_x, wanted.thrust_y, wanted.brake,
                                          dashes});
    }
}

TickFacts Match::Impl::step_world() {
    const physics::StepReport report = arena->advance(game::kTickDurationS);
    if (report.overrun) ++totals.overruns;

    const physics::CollisionAudit& here = arena->world().audit();
    audit = audit_before;
    audit.ball_collisions += here.ball_collisions;
    audit.wall_collisions += here.wall_collisions;
    audit.worst_energy_error = std::max(audit.worst_energy_error, here.worst_energy_error);
    audit.worst_momentum_error = std::max(audit.worst_momentum_error, here.worst_momentum_error);
    audit.energy_change_j += here.energy_change_j;
    audit.energy_seen_j += here.energy_seen_j;
    return {report.overrun, report.unspent_time_s};
}

void Match::Impl::snap() {
    arena->snap();
    audit_before = audit;
    log.forget_before(now - std::min(now, replication::kMaxPredictedTicks));
}

void Match::Impl::record_contacts() {
    for (const auto& contact : arena->contacts()) {
        if (!contact.b) continue;
        const std::uint16_t a = arena->id_at(contact.a.index);
        const std::uint16_t b = arena->id_at(contact.b->index);
        const Vec2d& velocity_a = contact.velocity_a_before_mps;
        const Vec2d& velocity_b = contact.velocity_b_before_mps;
        const Ball& ball_a = balls.at(a);
        const Ball& ball_b = balls.at(b);
        const Actor actor_a = actor_of(a, ball_a), actor_b = actor_of(b, ball_b);
        const auto full_momentum_ns = [](const Ball& ball) {
            return ball.stats.mass_kg * ball.stats.top_speed_mps;
        };
        attribution.record({actor_a, actor_b, now, contact.impulse_ns, full_momentum_ns(ball_a),
                            came_at(velocity_b, velocity_a, contact.normal)});
        attribution.record({actor_b, actor_a, now, contact.impulse_ns, full_momentum_ns(ball_b),
                            came_at(velocity_a, velocity_b, -contact.normal)});

        hits.add(replication::hit_of(contact, now, a, b));
        if (ball_a.player != 0) report_hit(a, b, contact, true);
        if (ball_b.player != 0) report_hit(b, a, contact, false);
    }
}

void Match::Impl::settle_falls() {
    struct Settled {
        std::uint16_t ball = 0;
        Vec2d fallen_at_m;
        std::vector<Attribution::Share> shares;
    };
    std::vector<Settled> settled;
    for (const auto& fall : arena->falls()) {
        const std::uint16_t id = arena->id_at(fall.id.index);
        settled.push_back(
            {id, fall.position_m, attribution.credit(actor_of(id, balls.at(id)), now)});
    }
    for (const Settled& fall : settled) settle_fall(fall.ball, fall.fallen_at_m, fall.shares);
}

void Match::Impl::settle_fall(std::uint16_t ball_id, const Vec2d& fallen_at_m,
                              const std::vector<Attribution::Share>& shares) {
    const PlayerId victim = balls.at(ball_id).player;
    replication::KnockOff news{ball_id, victim, {}};
    const std::vector<int> split = split_coins(game::knock_off_coins(level().number), shares);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const PlayerId id = shares[i].actor.player_id;
        if (!players.contains(id)) continue;
        ledger.award(players.at(id).key, split[i], Reason::kKnockOff);
        earn(id, split[i]);
        ++(shares[i].assist ? score(id).assists : score(id).knock_offs);
        news.shares.push_back({id, split[i], shares[i].assist});
    }
    tell_all(std::move(news));

    remove_ball(ball_id);
    if (victim == 0) {
        ++totals.ai_knock_offs;
        return;
    }
    Player& player = players.at(victim);
    player.ball = 0;
    --player.lives;
    player.spawn_tick = now + ticks_of(game::kRespawnDelayS);
    ++score(victim).falls;
    drop_coins(victim, fallen_at_m);
}

void Match::Impl::collect_coins() {
    std::erase_if(coins, [this](const auto& entry) {
        const Coin& coin = entry.second;
        PlayerId taker = 0;
        double nearest_m = 0.0;
        for (const auto& [id, player] : players) {
            if (player.ball == 0) continue;
            const Ball& ball = balls.at(player.ball);
            const double distance_m =
                (body(player.ball).position_m - coin.position_m).norm() - ball.stats.radius_m;
            if (distance_m > ball.stats.magnet_range_m) continue;
            if (taker != 0 && distance_m >= nearest_m) continue;
            taker = id;
            nearest_m = distance_m;
        }
        if (taker == 0) return false;
        ledger.pick_up(config.arena, players.at(taker).key, coin.value_coins);
        earn(taker, coin.value_coins);
        forget_coin(entry.first);
        return true;
    });
}

void Match::Impl::remember() {
    const double well_inside_m = Attribution::kCalmEdgeShare * inradius_m(level().platform);
    ai::Frame frame;
    frame.reserve(balls.size());
    for (const auto& [id, ball] : balls) {
        const auto seen = body(id);
        frame.push_back({.id = id,
                         .is_player = ball.player != 0,
                         .behaviour = ball.behaviour,
                         .position_m = seen.position_m,
                         .velocity_mps = seen.velocity_mps,
                         .radius_m = seen.radius_m,
                         .mass_kg = seen.mass_kg});
        const double room_m = physics::distance_to_edge_m(level().platform, seen.position_m);
        attribution.observe(actor_of(id, ball), now, room_m >= well_inside_m);
    }
    memory.remember(std::move(frame));
    attribution.expire(now);
}

void Match::Impl::judge_level() {
    const bool ai_left = !waiting_ai.empty() ||
                         std::any_of(balls.begin(), balls.end(),
                                     [](const auto& entry) { return entry.second.player == 0; });
    const bool all_out = std::all_of(players.begin(), players.end(),
                                     [](const auto& entry) { return entry.second.lives == 0; });
    if (!ai_left) {
        const bool last = level_index + 1 == config.levels.size();
        end_level(last ? LevelOutcome::kCampaignComplete : LevelOutcome::kCleared);
    } else if (all_out) {
        end_level(LevelOutcome::kLost);
    } else if (now >= phase_end) {
        end_level(LevelOutcome::kTimeUp);
    }
}

}  // namespace fts::server
