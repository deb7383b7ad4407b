// Idle: does nothing at all and buys nothing.
#pragma once

#include "client/bot/pilot.h"

namespace fts::bot {

class Idle final : public Pilot {
  public:
    game::InputCommand decide(const Sight&, Rng&) override { return {}; }
    std::span<const game::Stat> shopping_list() const override { return {}; }
};

}  // namespace fts::bot
