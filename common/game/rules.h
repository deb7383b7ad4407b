// Numbers of the game that both ends agree on. Units last in a name.
#pragma once

#include <cstdint>

namespace fts::game {

inline constexpr int kTickRateHz = 60;
inline constexpr double kTickDurationS = 1.0 / kTickRateHz;
inline constexpr int kSnapshotRateHz = 30;
inline constexpr std::uint16_t kDefaultPort = 7777;

inline constexpr int kMaxPlayersPerArena = 64;
inline constexpr int kDefaultPlayersPerArena = 16;
inline constexpr int kMaxNameBytes = 24;   // UTF-8
inline constexpr int kMaxChatBytes = 160;  // UTF-8

inline constexpr int kLivesPerLevel = 3;
inline constexpr double kRespawnDelayS = 2.0;
inline constexpr double kCountdownS = 3.0;
inline constexpr double kShopS = 20.0;  // ends sooner when every player is ready
inline constexpr double kCoinRadiusM = 0.25;

// Coins a knock-off on level L is worth: 4 + 0.4 (L - 1), rounded to the nearest whole coin.
int knock_off_coins(int level);
inline constexpr int kLevelClearCoins = 6;

}  // namespace fts::game
