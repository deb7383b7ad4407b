#include "client/bot/field.h"

#include <algorithm>

namespace fts::bot {
namespace {

using replication::dequantise;

FieldBall ball_of(const replication::BallState& state, const physics::Platform& platform) {
    FieldBall ball;
    ball.id = state.id;
    ball.player_id = state.player_id;
    ball.position_m = replication::position_of(state);
    ball.velocity_mps = replication::velocity_of(state);
    ball.radius_m = dequantise(state.radius, replication::kRadiusStepM);
    ball.mass_kg = dequantise(state.mass, replication::kMassStepKg);
    ball.to_edge_m = physics::distance_to_edge_m(platform, ball.position_m);
    return ball;
}

}  // namespace

Field field_of(const replication::Snapshot& snapshot, const physics::Platform& platform,
               int tick_rate_hz) {
    Field field;
    field.server_time_s = double(snapshot.tick) / tick_rate_hz;
    field.platform = platform;
    field.ai_balls.reserve(snapshot.balls.size());
    for (const replication::BallState& state : snapshot.balls) {
        const bool is_player =
            state.kind == static_cast<std::uint8_t>(replication::BallKind::kPlayer);
        (is_player ? field.player_balls : field.ai_balls).push_back(ball_of(state, platform));
    }
    for (const replication::CoinState& coin : snapshot.coins) {
        field.coins.push_back({coin.id, replication::place_m(coin.x, coin.y), coin.value_coins});
    }
    return field;
}

Sight sight_of(const Field& field, std::uint16_t own_player_id, const game::Tiers& tiers,
               double lag_s) {
    Sight sight{.field = field, .own = nullptr, .tiers = tiers, .lag_s = lag_s};
    const auto own = std::ranges::find(field.player_balls, own_player_id, &FieldBall::player_id);
    if (own_player_id != 0 && own != field.player_balls.end()) sight.own = &*own;
    return sight;
}

std::shared_ptr<const Field> Fields::of(const client::Glance& glance) {
    if (!glance.newest || !glance.platform) return nullptr;
    Arena& arena = arenas_[glance.newest->arena];
    const auto kept = std::ranges::find(arena.recent, glance.newest, &Kept::snapshot);
    if (kept != arena.recent.end()) return kept->field;
    Kept& made = arena.recent[arena.next];
    arena.next = (arena.next + 1) % arena.recent.size();
    made = {glance.newest, std::make_shared<const Field>(
                               field_of(*glance.newest, *glance.platform, glance.tick_rate_hz))};
    return made.field;
}

}  // namespace fts::bot
