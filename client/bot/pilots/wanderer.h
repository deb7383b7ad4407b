// Wanderer: rolls from one random point of the platform to the next, whoever is in the way.
#pragma once

#include "client/bot/pilot.h"

namespace fts::bot {

class Wanderer final : public Pilot {
  public:
    game::InputCommand decide(const Sight& sight, Rng& rng) override;
    std::span<const game::Stat> shopping_list() const override;

  private:
    physics::Vec2d goal_m_ = physics::Vec2d::Zero();
    double give_up_at_s_ = 0.0;  // server time
};

}  // namespace fts::bot
