// Chaser: knocks AI balls off. It picks the one that is easiest to get over the edge, goes round
// behind it, and charges the ghost ball: the place where its own centre is at contact, so that the
// line of centres points at the edge nearest to the target. Without AI balls it keeps to the safest
// place.
#pragma once

#include <optional>

#include "client/bot/pilot.h"

namespace fts::bot {

class Chaser final : public Pilot {
  public:
    game::InputCommand decide(const Sight& sight, Rng& rng) override;
    std::span<const game::Stat> shopping_list() const override;

  private:
    const FieldBall* choose_target(const Sight& sight);

    std::optional<std::uint16_t> target_id_;
};

}  // namespace fts::bot
