#include "client/bot/shopping.h"

namespace fts::bot {

std::optional<game::Stat> next_purchase(std::span<const game::Stat> wants, const game::Tiers& tiers,
                                        int coins) {
    std::optional<game::Stat> best;
    const auto tier_of = [&](game::Stat stat) { return tiers[static_cast<std::size_t>(stat)]; };
    for (const game::Stat stat : wants) {
        const auto price = game::price_coins(tier_of(stat));
        if (!price || *price > coins) continue;
        if (!best || tier_of(stat) < tier_of(*best)) best = stat;
    }
    return best;
}

}  // namespace fts::bot
