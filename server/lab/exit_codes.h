// How fts-lab ends.
#pragma once

namespace fts::lab {

inline constexpr int kExitFailure = 1;  // of the machine: a file cannot be written, ...
inline constexpr int kExitUsage = 2;    // of what was asked for: options and scenes
inline constexpr int kExitInterrupted = 130;

}  // namespace fts::lab
