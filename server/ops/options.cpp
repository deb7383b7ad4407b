#include "server/ops/options.h"

#include <cstdlib>
#include <filesystem>
#include <random>
#include <system_error>

#include <CLI/CLI.hpp>

#include "server/limits.h"
#include "server/plain_text.h"

namespace fts::server {

namespace {

std::uint64_t random_seed() {
    std::random_device device;
    return (std::uint64_t{device()} << 32U) | device();
}

void declare(CLI::App& app, Options& options) {
    app.add_option("--port", options.port, "UDP port to listen on; 0 for any free one")
        ->envname("FTS_PORT")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    app.add_option("--bind", options.bind, "Address to listen on; all of this machine's by default")
        ->envname("FTS_BIND");
    app.add_option("--data", options.data_folder, "Folder of the server's key and its ledger")
        ->envname("FTS_DATA")
        ->capture_default_str();
    app.add_option("--levels", options.levels_folder, "Folder of the campaign's *.level files")
        ->envname("FTS_LEVELS")
        ->capture_default_str();
    app.add_option("--arenas", options.arenas, "Matches played side by side")
        ->envname("FTS_ARENAS")
        ->check(CLI::Range(1, kMaxArenas))
        ->capture_default_str();
    app.add_option("--players", options.players_per_arena, "Players per arena")
        ->envname("FTS_PLAYERS")
        ->check(CLI::Range(1, game::kMaxPlayersPerArena))
        ->capture_default_str();
    app.add_option("--snapshot-rate", options.snapshot_rate_hz,
                   "Snapshots a second to each player: 20, 30 or 60")
        ->envname("FTS_SNAPSHOT_RATE")
        ->check(CLI::IsMember(std::vector<int>(kSnapshotRatesHz.begin(), kSnapshotRatesHz.end())))
        ->capture_default_str();
    app.add_option("--client-rate", options.client_bytes_per_s,
                   "Bytes a second that snapshots may take to each player, 16000 or more")
        ->envname("FTS_CLIENT_RATE")
        ->check(CLI::Range(kMinClientBytesPerS, kMaxClientBytesPerS))
        ->capture_default_str();
    app.add_option("--seed", options.seed, "Seed of the matches; a random one by default")
        ->envname("FTS_SEED");
    app.add_option("--name", options.name, "Name shown to players")
        ->envname("FTS_NAME")
        ->capture_default_str();
    app.add_option_function<std::string>(
           "--fidelity",
           [&options](const std::string& text) {
               const auto tolerance = physics::tolerance_from(text);
               if (!tolerance) {
                   throw CLI::ValidationError("--fidelity",
                                              "'" + text +
                                                  "' is neither auto, fast nor exact, nor an error "
                                                  "above 0 and below 1 such as 0.001");
               }
               options.tolerance = *tolerance;
           },
           "How exact collisions are: auto, fast, exact, or the error that is tolerated")
        ->envname("FTS_FIDELITY")
        ->default_str("auto");
    app.add_option("--log-level", options.log_level, "debug, info, warning, error or off")
        ->envname("FTS_LOG_LEVEL")
        ->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}))
        ->capture_default_str();
    app.add_option("--report", options.report_file, "JSON file written when the server ends")
        ->envname("FTS_REPORT");
    app.set_config("--config", "", "File with the same settings: port = 7777, name = \"...\"")
        ->envname("FTS_CONFIG");
    app.allow_config_extras(CLI::config_extras_mode::error);
}

}  // namespace

std::string default_data_folder() {
    const char* data_home = std::getenv("XDG_DATA_HOME");
    const char* home = std::getenv("HOME");
    std::filesystem::path base;
    if (data_home && *data_home) {
        base = data_home;
    } else if (home && *home) {
        base = std::filesystem::path(home) / ".local/share";
    } else {
        return {};
    }
    return (base / "fear-the-sphere" / "server").string();
}

std::string default_levels_folder() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) return {};
    return (program.parent_path().parent_path() / "share" / "fear-the-sphere" / "levels").string();
}

ParsedOptions parse_options(int argc, const char* const* argv) {
    Options options;
    options.seed = random_seed();
    options.data_folder = default_data_folder();
    options.levels_folder = default_levels_folder();

    CLI::App app("Hosts Fear The Sphere: an arena where balls knock each other off a platform.",
                 "fts-server");
    declare(app, options);
    app.failure_message([](const CLI::App*, const CLI::Error& error) {
        return "fts-server: " + std::string(error.what()) +
               "\nfts-server --help lists what can be set.\n";
    });
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return {std::nullopt, app.exit(error) == 0 ? 0 : kExitUsage};
    }
    options.name = plain_line(options.name, kMaxServerNameBytes);
    if (options.name.empty()) options.name = Options{}.name;
    return {std::move(options), 0};
}

}  // namespace fts::server
