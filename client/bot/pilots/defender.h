// Defender: keeps to the safest place and meets every ball that comes near with a counter-blow.
#pragma once

#include "client/bot/pilot.h"

namespace fts::bot {

class Defender final : public Pilot {
  public:
    game::InputCommand decide(const Sight& sight, Rng& rng) override;
    std::span<const game::Stat> shopping_list() const override;
};

}  // namespace fts::bot
