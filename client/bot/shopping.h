// What a bot buys next with the coins that it has.
#pragma once

#include <optional>
#include <span>

#include "common/game/upgrades.h"

namespace fts::bot {

// The affordable one of `wants` with the lowest tier; of equals the earlier one. Empty when nothing
// that is wanted can be afforded.
std::optional<game::Stat> next_purchase(std::span<const game::Stat> wants, const game::Tiers& tiers,
                                        int coins);

}  // namespace fts::bot
