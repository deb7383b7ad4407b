// fts-server: hosts arenas until it is told to stop, then prints what came of them.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "common/net/connection.h"
#include "common/net/udp_transport.h"
#include "server/duration_histogram.h"
#include "server/economy/store_sqlite.h"
#include "server/match/level_file.h"
#include "server/ops/logging.h"
#include "server/ops/options.h"
#include "server/ops/report.h"
#include "server/server.h"

namespace fts::server {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int) {
    stop_requested = 1;
}

// Without SA_RESTART, so that waiting for a datagram ends as well.
void listen_for_signals() {
    struct sigaction stop {};
    stop.sa_handler = request_stop;
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaction(signal, &stop, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
}

double monotonic_now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// Everything a server needs from the machine it runs on.
struct Resources {
    ServerConfig config;
    std::unique_ptr<Store> store;
    std::unique_ptr<net::UdpTransport> transport;
};

std::optional<Resources> acquire(const Options& options, std::string& error) {
    Resources resources;
    ServerConfig& config = resources.config;
    config.name = options.name;
    config.arenas = options.arenas;
    config.players_per_arena = options.players_per_arena;
    config.snapshot_rate_hz = options.snapshot_rate_hz;
    config.client_bytes_per_s = options.client_bytes_per_s;
    config.stage_clock = monotonic_now_s;
    config.seed = options.seed;
    config.tolerance = options.tolerance;

    LoadedLevels levels = load_levels(options.levels_folder);
    if (!levels.error.empty()) {
        error = levels.error;
        return std::nullopt;
    }
    config.levels = std::move(levels.levels);

    if (options.data_folder.empty()) {
        error = "neither HOME nor XDG_DATA_HOME is set; name a data folder (--data)";
        return std::nullopt;
    }
    const std::filesystem::path data = options.data_folder;
    std::error_code failure;
    std::filesystem::create_directories(data, failure);
    if (failure) {
        error = "cannot make the data folder '" + data.string() + "' (" + failure.message() +
                "); choose one this user may write to (--data)";
        return std::nullopt;
    }
    const auto key = net::load_or_create_key_pair((data / "server.key").string(), error);
    if (!key) return std::nullopt;
    config.key = *key;

    resources.store = open_sqlite_store((data / "ledger.sqlite3").string(), error);
    if (!resources.store) return std::nullopt;
    resources.transport = net::UdpTransport::open(options.bind, options.port, error);
    if (!resources.transport) return std::nullopt;
    return resources;
}

// What arrives within this time of a first datagram is received together with it: waking up for
// each costs more than it brings.
constexpr double kGatherS = 1e-3;

void wait_for_work(const Server& server, net::UdpTransport& transport) {
    transport.wait_readable(std::max(0.0, server.next_tick_s() - monotonic_now_s()));
    const double left_s = server.next_tick_s() - monotonic_now_s();
    if (left_s <= 0.0) return;
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left_s, kGatherS)));
}

void serve(Server& server, net::UdpTransport& transport, DurationHistogram& tick_durations) {
    while (!stop_requested) {
        const double began_s = monotonic_now_s();
        if (server.tick(began_s) > 0) tick_durations.record(monotonic_now_s() - began_s);
        wait_for_work(server, transport);
    }
}

int complain(const std::string& message) {
    std::fprintf(stderr, "fts-server: %s\n", message.c_str());
    return kExitFailure;
}

int conclude(const Server& server, const RunFacts& run, const std::string& report_file) {
    const ServerReport report = server.report();
    std::fputs(text_of(report, run).c_str(), stdout);
    std::fflush(stdout);
    std::string error;
    if (!report_file.empty() && !write_report(report_file, json_of(report, run), error)) {
        return complain(error);
    }
    if (report.unwritten_transactions > 0) {
        return complain(std::to_string(report.unwritten_transactions) +
                        " transactions could not be written to the ledger and are lost; see that "
                        "its disk is not full");
    }
    return 0;
}

int run(const Options& options) {
    listen_for_signals();
    std::string error;
    std::optional<Resources> resources = acquire(options, error);
    if (!resources) return complain(error);

    const Log log = open_log(options.log_level);
    log(LogLevel::kInfo, "arenas: " + std::to_string(options.arenas) +
                             ", players in each: " + std::to_string(options.players_per_arena) +
                             ", levels: " + std::to_string(resources->config.levels.size()) +
                             ", seed: " + std::to_string(options.seed) +
                             ", data: " + options.data_folder +
                             ", key: " + net::short_name(resources->config.key.public_key));
    Server server(resources->config, *resources->transport, std::move(resources->store), log);
    std::printf("fts-server: listening on UDP port %u\n",
                unsigned{resources->transport->local_port()});
    std::fflush(stdout);

    RunFacts facts;
    serve(server, *resources->transport, facts.tick_durations);
    log(LogLevel::kInfo, "stopping; players here: " + std::to_string(server.player_count()));
    server.shut_down(monotonic_now_s(), "the server is shutting down");
    facts.cpu_s = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    facts.traffic = resources->transport->stats();
    return conclude(server, facts, options.report_file);
}

}  // namespace
}  // namespace fts::server

int main(int argc, char** argv) {
    const fts::server::ParsedOptions parsed = fts::server::parse_options(argc, argv);
    return parsed.options ? fts::server::run(*parsed.options) : parsed.exit_code;
}
