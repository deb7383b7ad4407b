// What a host may choose: by flag, in a configuration file, or by environment variable (FTS_PORT
// for --port, and so on). A flag goes before the file, the file before the environment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/game/rules.h"
#include "common/physics/fidelity.h"
#include "server/limits.h"

namespace fts::server {

inline constexpr int kExitFailure = 1;
inline constexpr int kExitUsage = 2;

struct Options {
    std::string bind;                         // empty: every interface
    std::uint16_t port = game::kDefaultPort;  // 0: any free one
    std::string data_folder;
    std::string levels_folder;
    int arenas = 1;
    int players_per_arena = game::kDefaultPlayersPerArena;
    int snapshot_rate_hz = game::kSnapshotRateHz;
    int client_bytes_per_s = kDefaultClientBytesPerS;
    std::uint64_t seed = 0;
    std::string name = "Fear The Sphere";
    double tolerance = physics::kAutoTolerance;  // of collisions, as in common/physics/fidelity.h
    std::string log_level = "info";
    std::string report_file;  // empty: none
};

struct ParsedOptions {
    std::optional<Options> options;
    int exit_code = 0;  // when there are none: help was printed (0), or what is wrong with them (2)
};
// Fills in defaults: a random seed, the data folder of the user, the levels beside the executable.
ParsedOptions parse_options(int argc, const char* const* argv);

// $XDG_DATA_HOME/fear-the-sphere/server or ~/.local/share/fear-the-sphere/server; empty when
// neither variable is set.
std::string default_data_folder();
// share/fear-the-sphere/levels beside the bin folder of this executable.
std::string default_levels_folder();

}  // namespace fts::server
