#include "common/game/upgrades.h"

#include <algorithm>
#include <cassert>

namespace fts::game {

namespace {

constexpr std::array<std::string_view, kStatCount> kNames = {"mass",    "thrust", "top speed",
                                                             "braking", "dash",   "magnet"};
constexpr std::array<int, kMaxTier> kPricesCoins = {14, 20, 27, 38, 54, 75};

constexpr double kMassFactorPerTier = 1.12;
constexpr double kThrustGainPerTier = 0.12;
constexpr double kTopSpeedGainPerTier = 0.06;
constexpr double kBrakingGainPerTier = 0.15;
constexpr double kDashRechargeGainPerTier = -0.08;
constexpr double kMagnetGainPerTier = 0.15;

constexpr BallStats kBase = {.radius_m = 0.5,
                             .mass_kg = 1.0,
                             .thrust_n = 9.0,
                             .top_speed_mps = 9.0,
                             .braking_per_s = 1.5,
                             .dash_speed_mps = 4.0,
                             .dash_recharge_s = 4.0,
                             .magnet_range_m = 0.6};

int tier_of(const Tiers& tiers, Stat stat) {
    return tiers[static_cast<std::size_t>(stat)];
}

double gained(double base, double gain_per_tier, int tier) {
    return base * (1.0 + gain_per_tier * tier);
}

// By repeated multiplication: std::pow may differ in the last bit from one machine to the next.
double compounded(double base, double factor_per_tier, int tier) {
    for (int i = 0; i < tier; ++i) base *= factor_per_tier;
    return base;
}

}  // namespace

std::string_view name_of(Stat stat) {
    return kNames[static_cast<std::size_t>(stat)];
}

std::optional<Stat> stat_named(std::string_view name) {
    const auto same = [name](std::string_view known) {
        return std::ranges::equal(known, name,
                                  [](char a, char b) { return a == b || (a == ' ' && b == '_'); });
    };
    const auto found = std::ranges::find_if(kNames, same);
    if (found == kNames.end()) return std::nullopt;
    return static_cast<Stat>(found - kNames.begin());
}

bool valid(const Tiers& tiers) {
    return std::ranges::all_of(tiers, [](std::uint8_t tier) { return tier <= kMaxTier; });
}

std::optional<int> price_coins(int tier) {
    if (tier < 0 || tier >= kMaxTier) return std::nullopt;
    return kPricesCoins[static_cast<std::size_t>(tier)];
}

BallStats stats_for(const Tiers& tiers) {
    assert(valid(tiers));
    BallStats stats = kBase;
    stats.mass_kg = compounded(kBase.mass_kg, kMassFactorPerTier, tier_of(tiers, Stat::kMass));
    stats.thrust_n = gained(kBase.thrust_n, kThrustGainPerTier, tier_of(tiers, Stat::kThrust));
    stats.top_speed_mps =
        gained(kBase.top_speed_mps, kTopSpeedGainPerTier, tier_of(tiers, Stat::kTopSpeed));
    stats.braking_per_s =
        gained(kBase.braking_per_s, kBrakingGainPerTier, tier_of(tiers, Stat::kBraking));
    stats.dash_recharge_s =
        gained(kBase.dash_recharge_s, kDashRechargeGainPerTier, tier_of(tiers, Stat::kDash));
    stats.magnet_range_m =
        gained(kBase.magnet_range_m, kMagnetGainPerTier, tier_of(tiers, Stat::kMagnet));
    return stats;
}

}  // namespace fts::game
