// fts-bot: headless players for tests and load. Exit status: 0 when all went as expected, 1 when an
// expectation was not met or nobody could join, 2 when flags or script are wrong.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <thread>

#include <CLI/CLI.hpp>

#include "client/bot/crowd.h"
#include "client/bot/expectations.h"
#include "client/bot/report.h"
#include "client/bot/script.h"

namespace fts {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kOk = 0, kFailed = 1, kUsage = 2;
constexpr double kLoopHz = 120.0;
// Asked this rarely whether the run is over, as adding all counts up takes time.
constexpr double kFinishedCheckS = 0.1;
// How long goodbyes are given to leave through a slow simulated network.
constexpr double kGoodbyeS = 0.05;

volatile std::sig_atomic_t g_interrupted = 0;
void interrupt(int) {
    g_interrupted = 1;
}

struct Options {
    bot::CrowdConfig crowd;
    double seconds = 30.0;
    std::string script, json;
    double loss = 0.0, delay_ms = 0.0, jitter_ms = 0.0;
};

std::string pilot_list() {
    std::string list;
    for (const std::string_view name : bot::pilot_names()) {
        list += (list.empty() ? "" : ", ") + std::string(name);
    }
    return list;
}

std::string check_pilot(const std::string& name) {
    if (bot::make_pilot(name)) return "";
    return "there is no pilot '" + name + "'; give one of " + pilot_list();
}

void declare(CLI::App& app, Options& options) {
    bot::CrowdConfig& crowd = options.crowd;
    crowd.server = "127.0.0.1";
    app.add_option("--server", crowd.server, "HOST[:PORT] to join")->capture_default_str();
    app.add_option("--bots", crowd.bots, "How many players")
        ->check(CLI::Range(1, bot::kMaxBots))
        ->capture_default_str();
    app.add_option("--seconds", options.seconds, "How long to play")
        ->check(CLI::Range(0.1, 86400.0))
        ->capture_default_str();
    app.add_option("--pilot", crowd.pilot, "Who steers: " + pilot_list())
        ->check(CLI::Validator(check_pilot, "", "pilot"))
        ->capture_default_str();
    app.add_option("--name", crowd.name_prefix, "Players are called NAME-0, NAME-1, ...")
        ->capture_default_str();
    app.add_option("--seed", crowd.seed, "Of pilots and simulated network")->capture_default_str();
    app.add_option("--arena", crowd.arena, "Arena to join; -1 for any with room")
        ->check(CLI::Range(-1, 255))
        ->capture_default_str();
    app.add_option("--script", options.script, "JSON file with steps and expectations");
    app.add_option("--json", options.json, "Write the report to this file");
    app.add_option("--hits", crowd.hits, "Write every hit of the players' balls to this CSV file");
    app.add_option("--data", crowd.data,
                   "Folder that keeps keys, so that the same players come back");
    app.add_option("--loss", options.loss, "Simulated: share of datagrams lost, each way")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--delay-ms", options.delay_ms, "Simulated: delay each way")
        ->check(CLI::Range(0.0, 10000.0));
    app.add_option("--jitter-ms", options.jitter_ms, "Simulated: the delay varies by +- this")
        ->check(CLI::Range(0.0, 10000.0));
    app.add_option("--protocol-version", crowd.protocol_version,
                   "Version to claim, to see what a server answers")
        ->capture_default_str();
}

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void play(bot::Crowd& crowd, double seconds, bot::Report& report) {
    const Clock::time_point start = Clock::now();
    const auto period =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / kLoopHz));
    Clock::time_point next = start;
    double now_s = 0.0, last_s = 0.0, next_check_s = 0.0;
    std::uint64_t rounds = 0;
    for (bool over = false; !over; ++rounds) {
        now_s = seconds_since(start);
        report.loop_longest_gap_s = std::max(report.loop_longest_gap_s, now_s - last_s);
        last_s = now_s;
        crowd.update(now_s);
        over = g_interrupted != 0 || now_s >= seconds;
        if (!over && now_s >= next_check_s) {
            over = crowd.finished();
            next_check_s = now_s + kFinishedCheckS;
        }
        next = std::max(next + period, Clock::now());
        if (!over) std::this_thread::sleep_until(next);
    }
    report.seconds = now_s;
    report.loop_mean_hz = now_s > 0.0 ? static_cast<double>(rounds) / now_s : 0.0;
    report.cpu_s = double(std::clock()) / CLOCKS_PER_SEC;
    report.tallies = crowd.tallies();
}

// Sessions end here, after what is reported was counted; held-back goodbyes are moved on.
void say_goodbye(bot::Crowd& crowd, const Options& options, double now_s) {
    crowd.retire(now_s);
    const double until_s = now_s + kGoodbyeS + (options.delay_ms + options.jitter_ms) * 1e-3;
    for (; now_s < until_s; now_s += 1.0 / kLoopHz) {
        std::this_thread::sleep_for(std::chrono::duration<double>(1.0 / kLoopHz));
        crowd.update(now_s);
    }
    crowd.update(until_s);
}

bool anybody_joined(const bot::Report& report) {
    return std::ranges::any_of(report.tallies, &bot::Tally::joined);
}

bool as_expected(const bot::Script& script, const bot::Report& report) {
    const bool all_met = std::ranges::all_of(report.verdicts, &bot::Verdict::met);
    return all_met && (anybody_joined(report) || bot::minds_who_joins(script.expect));
}

int run(Options& options) {
    const auto parsed = options.script.empty()
                            ? bot::ParsedScript{bot::Script{}, ""}
                            : bot::read_script(options.script, options.crowd.bots);
    if (!parsed.script) {
        std::fprintf(stderr, "fts-bot: %s\n", parsed.error.c_str());
        return kUsage;
    }
    if (options.loss > 0.0 || options.delay_ms > 0.0 || options.jitter_ms > 0.0) {
        options.crowd.conditions = net::LinkConditions{.loss = options.loss,
                                                       .delay_s = options.delay_ms * 1e-3,
                                                       .jitter_s = options.jitter_ms * 1e-3};
    }
    std::string error;
    const auto crowd = bot::Crowd::open(options.crowd, *parsed.script, error);
    if (!crowd) {
        std::fprintf(stderr, "fts-bot: %s\n", error.c_str());
        return kFailed;
    }
    bot::Report report;
    play(*crowd, options.seconds, report);
    report.verdicts = bot::judge(parsed.script->expect, report.tallies);
    report.passed = as_expected(*parsed.script, report);
    say_goodbye(*crowd, options, report.seconds);
    report.problems = crowd->problems();
    std::fputs(bot::as_tables(report).c_str(), stdout);
    std::fflush(stdout);
    if (!options.json.empty() &&
        !(std::ofstream(options.json) << bot::as_json(report) << std::flush)) {
        std::fprintf(stderr, "fts-bot: cannot write %s. Give --json a file that can be written.\n",
                     options.json.c_str());
        return kFailed;
    }
    return report.passed ? kOk : kFailed;
}

int main_of_bots(int argc, char** argv) {
    std::signal(SIGINT, interrupt);
    std::signal(SIGTERM, interrupt);
    CLI::App app{"Headless players for Fear The Sphere: they join a server, play, and report."};
    Options options;
    declare(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kOk : kUsage;
    }
    return run(options);
}

}  // namespace
}  // namespace fts

int main(int argc, char** argv) {
    return fts::main_of_bots(argc, argv);
}
