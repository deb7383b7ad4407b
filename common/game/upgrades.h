// The six upgrades: physical quantities of a player's ball, bought tier by tier for coins.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace fts::game {

enum class Stat : std::uint8_t { kMass, kThrust, kTopSpeed, kBraking, kDash, kMagnet };
inline constexpr std::size_t kStatCount = 6;
inline constexpr int kMaxTier = 6;

std::string_view name_of(Stat stat);                    // "mass", "thrust", "top speed", ...
std::optional<Stat> stat_named(std::string_view name);  // accepts "top_speed" as well

using Tiers = std::array<std::uint8_t, kStatCount>;  // each [0, kMaxTier]
bool valid(const Tiers& tiers);

// Price in coins of going from `tier` to `tier + 1`: round(14 x 1.4^tier) = 14 20 27 38 54 75.
// Empty at the last tier.
std::optional<int> price_coins(int tier);

// What the tiers amount to. Mass compounds, x1.12 a tier; the others gain a share of their base
// value a tier: thrust +12 %, top speed +6 %, braking +15 %, dash recharge -8 %, magnet +15 %.
struct BallStats {
    double radius_m = 0.0;
    double mass_kg = 0.0;
    double thrust_n = 0.0;
    double top_speed_mps = 0.0;
    double braking_per_s = 0.0;   // drag added while the brake is held
    double dash_speed_mps = 0.0;  // velocity change of one dash
    double dash_recharge_s = 0.0;
    double magnet_range_m = 0.0;  // coins this far from the ball's edge are picked up
};
BallStats stats_for(const Tiers& tiers);

}  // namespace fts::game
