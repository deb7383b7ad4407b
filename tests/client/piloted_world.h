// A small world without a network: one ball that a pilot steers, others that nobody does. The pilot
// sees it as late as it would over a link.
#pragma once

#include <deque>
#include <vector>

#include "client/bot/pilot.h"
#include "common/game/movement.h"
#include "common/physics/world.h"

namespace fts::bot {

class PilotedWorld {
  public:
    // The first of `balls` is the pilot's.
    PilotedWorld(const physics::Platform& platform, const std::vector<physics::BodyDef>& balls,
                 int lag_ticks);

    void add_coin(const physics::Vec2d& position_m);
    // One tick of 60 Hz.
    void tick(Pilot& pilot, Rng& rng);

    bool pilot_is_on() const { return world_.contains(ids_.front()); }
    // Without the pilot's.
    std::size_t balls_left() const { return world_.size() - (pilot_is_on() ? 1U : 0U); }
    std::size_t coins_left() const { return coins_.size(); }
    double seconds() const;

    // As it is now.
    Field field() const;
    // The pilot's own, of `field`, which is so late.
    Sight sight(const Field& field) const;

  private:
    physics::Platform platform_;
    physics::World<double> world_;
    std::vector<physics::BodyId> ids_;
    std::vector<client::CoinView> coins_;
    game::BallStats stats_ = game::stats_for({});
    game::DashState dash_;
    std::deque<Field> seen_;
    std::size_t lag_ticks_;
    int ticks_ = 0;
};

}  // namespace fts::bot
