#include "client/bot/pilots/collector.h"

#include <algorithm>
#include <array>

#include "client/bot/steering.h"

namespace fts::bot {
namespace {

constexpr std::array kCollectorWants = {game::Stat::kMagnet, game::Stat::kTopSpeed,
                                        game::Stat::kThrust, game::Stat::kBraking};

}  // namespace

game::InputCommand Collector::decide(const Sight& sight, Rng& rng) {
    const auto helm = take_helm(sight);
    if (!helm) return {};
    const auto distance_m = [&](const client::CoinView& coin) {
        return (coin.position_m - helm->position_m).norm();
    };
    const auto nearest = std::ranges::min_element(sight.field.coins, {}, distance_m);
    if (nearest == sight.field.coins.end()) return meanwhile_.decide(sight, rng);
    return stay_on(*helm, fly_to(*helm, nearest->position_m));
}

std::span<const game::Stat> Collector::shopping_list() const {
    return kCollectorWants;
}

}  // namespace fts::bot
