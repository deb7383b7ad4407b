// What a level may hold. A level that comes from a file may hold anything; the match expects one
// that this accepts.
#pragma once

#include <optional>
#include <string>

#include "common/game/level.h"

namespace fts::server {

inline constexpr int kMaxAiBalls = 2000;
inline constexpr int kMaxLevelFieldCoins = 200;
inline constexpr std::size_t kMaxLevelNameBytes = 40;
inline constexpr std::size_t kMaxLevelHintBytes = 200;
// Balls may cover this share of the platform at most, so that everybody finds room.
inline constexpr double kMaxCover = 0.25;

// Empty when all is well; else names field, value and remedy: "ai[1].mass_kg is -2; give a mass
// between 0.05 and 100".
std::optional<std::string> fault_of(const game::Level& level);

}  // namespace fts::server
