// Collector: rolls over the nearest coin; while none lies about it defends itself.
#pragma once

#include "client/bot/pilot.h"
#include "client/bot/pilots/defender.h"

namespace fts::bot {

class Collector final : public Pilot {
  public:
    game::InputCommand decide(const Sight& sight, Rng& rng) override;
    std::span<const game::Stat> shopping_list() const override;

  private:
    Defender meanwhile_;
};

}  // namespace fts::bot
