#include "tests/client/piloted_world.h"

#include <optional>

#include "common/game/rules.h"

namespace fts::bot {
namespace {

constexpr std::uint16_t kPilotsId = 1;

physics::Scene scene_of(const physics::Platform& platform,
                        const std::vector<physics::BodyDef>& balls) {
    physics::Scene scene;
    scene.bodies = balls;
    scene.platform = platform;
    return scene;
}

}  // namespace

PilotedWorld::PilotedWorld(const physics::Platform& platform,
                           const std::vector<physics::BodyDef>& balls, int lag_ticks)
    : platform_(platform),
      world_(scene_of(platform, balls)),
      ids_(world_.ids().begin(), world_.ids().end()),
      lag_ticks_(static_cast<std::size_t>(lag_ticks)) {}

void PilotedWorld::add_coin(const physics::Vec2d& position_m) {
    coins_.push_back({static_cast<std::uint16_t>(coins_.size() + 1), position_m, 1});
}

double PilotedWorld::seconds() const {
    return ticks_ * game::kTickDurationS;
}

Field PilotedWorld::field() const {
    Field field;
    field.server_time_s = seconds();
    field.platform = platform_;
    field.coins = coins_;
    for (std::size_t i = 0; i < ids_.size(); ++i) {
        if (!world_.contains(ids_[i])) continue;
        const auto body = world_.body(ids_[i]);
        FieldBall ball;
        ball.id = static_cast<std::uint16_t>(i + 1);
        ball.position_m = body.position_m;
        ball.velocity_mps = body.velocity_mps;
        ball.radius_m = body.radius_m;
        ball.mass_kg = body.mass_kg;
        ball.to_edge_m = physics::distance_to_edge_m(platform_, body.position_m);
        ball.player_id = i == 0 ? kPilotsId : std::uint16_t{0};
        (i == 0 ? field.player_balls : field.ai_balls).push_back(ball);
    }
    return field;
}

Sight PilotedWorld::sight(const Field& field) const {
    return sight_of(field, kPilotsId, {}, static_cast<double>(lag_ticks_) * game::kTickDurationS);
}

void PilotedWorld::tick(Pilot& pilot, Rng& rng) {
    seen_.push_back(field());
    if (seen_.size() > lag_ticks_ + 1) seen_.pop_front();
    if (pilot_is_on()) {
        const game::InputCommand command = pilot.decide(sight(seen_.front()), rng);
        const game::Handling handling = game::handling_of(stats_);
        world_.set_control(ids_.front(), game::control_for(handling, command));
        const auto own = world_.body(ids_.front());
        if (game::advance_dash(dash_, stats_, command, game::kTickRateHz)) {
            world_.set_velocity(ids_.front(), own.velocity_mps + game::dash_for(handling, command));
        }
        std::erase_if(coins_, [&](const client::CoinView& coin) {
            return (coin.position_m - own.position_m).norm() <
                   own.radius_m + game::kCoinRadiusM + stats_.magnet_range_m;
        });
    }
    world_.step(game::kTickDurationS);
    ++ticks_;
}

}  // namespace fts::bot
