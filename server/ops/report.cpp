#include "server/ops/report.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

namespace fts::server {

namespace {

// fmt pads by estimated width on a terminal, which is what a column of names needs.
constexpr const char* kScoreHeader = "  {:>3}  {:<24}  {:>10}  {:>7}  {:>5}  {:>6}\n";
constexpr const char* kScoreLine = "  {:>3}  {:<24}  {:>10}  {:>7}  {:>5}  {:>6}\n";
constexpr const char* kFact = "  {:<22}{}\n";

std::string scoreboard_of(const ArenaReport& arena) {
    std::string text =
        fmt::format("Arena {}, level {}: {} cleared, {} lost\n", arena.arena, arena.level,
                    arena.totals.levels_cleared, arena.totals.levels_lost);
    if (arena.scoreboard.empty()) return text + "  nobody played here\n";
    text += fmt::format(kScoreHeader, "", "player", "knock-offs", "assists", "falls", "coins");
    int rank = 0;
    for (const ScoreLine& line : arena.scoreboard) {
        text += fmt::format(kScoreLine, ++rank, line.name, line.knock_offs, line.assists,
                            line.falls, line.coins_earned);
    }
    return text;
}

std::uint64_t falls_of(const ServerReport& report) {
    std::uint64_t falls = 0;
    for (const ArenaReport& arena : report.arenas) {
        falls += arena.totals.ai_knock_offs;
        for (const ScoreLine& line : arena.scoreboard) {
            falls += static_cast<std::uint64_t>(line.falls);
        }
    }
    return falls;
}

std::uint64_t world_overruns_of(const ServerReport& report) {
    std::uint64_t overruns = 0;
    for (const ArenaReport& arena : report.arenas) overruns += arena.totals.overruns;
    return overruns;
}

double relative_energy_change(const physics::CollisionAudit& audit) {
    return audit.energy_seen_j > 0.0 ? audit.energy_change_j / audit.energy_seen_j : 0.0;
}

nlohmann::json json_of(const physics::CollisionAudit& audit) {
    return {{"ball_collisions", audit.ball_collisions},
            {"wall_collisions", audit.wall_collisions},
            {"worst_energy_error", audit.worst_energy_error},
            {"worst_momentum_error", audit.worst_momentum_error},
            {"energy_change_j", audit.energy_change_j},
            {"energy_seen_j", audit.energy_seen_j},
            {"relative_energy_change", relative_energy_change(audit)}};
}

nlohmann::json json_of(const ArenaReport& arena) {
    nlohmann::json scoreboard = nlohmann::json::array();
    for (const ScoreLine& line : arena.scoreboard) {
        scoreboard.push_back({{"player", line.player},
                              {"name", line.name},
                              {"knock_offs", line.knock_offs},
                              {"assists", line.assists},
                              {"falls", line.falls},
                              {"coins_earned", line.coins_earned},
                              {"coins_dropped", line.coins_dropped}});
    }
    const MatchTotals& totals = arena.totals;
    return {{"arena", arena.arena},
            {"level", arena.level},
            {"scoreboard", scoreboard},
            {"ticks", totals.ticks},
            {"overruns", totals.overruns},
            {"ai_knock_offs", totals.ai_knock_offs},
            {"levels_cleared", totals.levels_cleared},
            {"levels_lost", totals.levels_lost},
            {"limits_reached",
             {{"spawns_delayed", totals.spawns_delayed},
              {"hits_left_out", totals.hits_left_out},
              {"reports_left_out", totals.reports_left_out},
              {"contacts_forgotten", totals.contacts_forgotten},
              {"drops_refused", totals.drops_refused},
              {"scores_forgotten", totals.scores_forgotten}}},
            {"audit", json_of(arena.audit)}};
}

double per(double amount, double of) {
    return of > 0.0 ? amount / of : 0.0;
}

// Stages that were not timed are left out.
std::string stages_of(const ServerReport& report) {
    if (report.stages.front().count() == 0) return "";
    constexpr const char* kRow = "  {:<12}{:>9}  {:>9}  {:>9}  {:>9}\n";
    std::string text =
        "Stages of a tick, us\n" + fmt::format(kRow, "", "mean", "p50", "p99", "max");
    const auto us = [](double duration_s) { return fmt::format("{:.1f}", 1e6 * duration_s); };
    for (std::size_t i = 0; i < report.stages.size(); ++i) {
        const DurationHistogram& stage = report.stages[i];
        text += fmt::format(kRow, kStageNames[i], us(stage.mean_s()), us(stage.quantile_s(0.5)),
                            us(stage.quantile_s(0.99)), us(stage.max_s()));
    }
    return text;
}

nlohmann::json stages_json_of(const ServerReport& report) {
    nlohmann::json stages = nlohmann::json::object();
    for (std::size_t i = 0; i < report.stages.size(); ++i) {
        const DurationHistogram& stage = report.stages[i];
        if (stage.count() == 0) continue;
        stages[std::string(kStageNames[i])] = {{"mean_us", 1e6 * stage.mean_s()},
                                               {"p50_us", 1e6 * stage.quantile_s(0.5)},
                                               {"p99_us", 1e6 * stage.quantile_s(0.99)},
                                               {"max_us", 1e6 * stage.max_s()}};
    }
    return stages;
}

std::string drops_of(const ServerReport& report) {
    std::string text;
    for (const auto& [reason, count] : report.drops) {
        if (count > 0) text += fmt::format(kFact, reason, count);
    }
    return text.empty() ? "" : "Dropped or refused\n" + text;
}

}  // namespace

physics::CollisionAudit combined_audit(const ServerReport& report) {
    physics::CollisionAudit all;
    for (const ArenaReport& arena : report.arenas) {
        const physics::CollisionAudit& audit = arena.audit;
        all.ball_collisions += audit.ball_collisions;
        all.wall_collisions += audit.wall_collisions;
        all.worst_energy_error = std::max(all.worst_energy_error, audit.worst_energy_error);
        all.worst_momentum_error = std::max(all.worst_momentum_error, audit.worst_momentum_error);
        all.energy_change_j += audit.energy_change_j;
        all.energy_seen_j += audit.energy_seen_j;
    }
    return all;
}

std::string text_of(const ServerReport& report, const RunFacts& run) {
    std::string text = "Scoreboard\n";
    for (const ArenaReport& arena : report.arenas) text += scoreboard_of(arena);

    const physics::CollisionAudit audit = combined_audit(report);
    const auto fact = [&text](const char* name, const std::string& value) {
        text += fmt::format(kFact, name, value);
    };
    text += "Conservation\n";
    fact("collisions", fmt::format("{} of two balls, {} with a wall", audit.ball_collisions,
                                   audit.wall_collisions));
    fact("knock-offs", fmt::format("{} balls left the platform", falls_of(report)));
    fact("worst energy error", fmt::format("{:.2e} of the pair's energy, in any one collision",
                                           audit.worst_energy_error));
    fact("worst momentum error", fmt::format("{:.2e} of the pair's momentum, in any one collision",
                                             audit.worst_momentum_error));
    fact("net energy change",
         fmt::format("{:+.2e} of the energy in all collisions", relative_energy_change(audit)));
    fact("coins", fmt::format("{} minted {} {} held + {} spent + {} dropped", report.coins.minted,
                              report.coins.balanced() ? "=" : "IS NOT", report.coins.held,
                              report.coins.spent, report.coins.dropped));
    text += "Ticks\n";
    fact("played", fmt::format("{}; {} overran the event budget, {} came too late and were dropped",
                               report.ticks, world_overruns_of(report), report.dropped_ticks));
    fact("missed",
         fmt::format("{}: {} made up for, {} dropped", report.late_ticks + report.dropped_ticks,
                     report.late_ticks, report.dropped_ticks));
    const DurationHistogram& durations = run.tick_durations;
    fact("duration",
         fmt::format("p50 {:.2f} ms, p99 {:.2f} ms, max {:.2f} ms", 1e3 * durations.quantile_s(0.5),
                     1e3 * durations.quantile_s(0.99), 1e3 * durations.max_s()));
    fact("CPU", fmt::format("{:.2f} s, {:.3f} ms a tick", run.cpu_s,
                            1e3 * per(run.cpu_s, static_cast<double>(report.ticks))));
    const double player_s = static_cast<double>(report.player_ticks) * game::kTickDurationS;
    fact("traffic", fmt::format("{:.0f} bytes/s to each player, {:.0f} from each",
                                per(static_cast<double>(run.traffic.bytes_sent), player_s),
                                per(static_cast<double>(run.traffic.bytes_received), player_s)));
    return text + stages_of(report) + drops_of(report);
}

std::string json_of(const ServerReport& report, const RunFacts& run) {
    const DurationHistogram& durations = run.tick_durations;
    nlohmann::json arenas = nlohmann::json::array();
    for (const ArenaReport& arena : report.arenas) arenas.push_back(json_of(arena));
    const nlohmann::json json = {{"arenas", arenas},
                                 {"audit", json_of(combined_audit(report))},
                                 {"knock_offs", falls_of(report)},
                                 {"coins",
                                  {{"minted", report.coins.minted},
                                   {"held", report.coins.held},
                                   {"spent", report.coins.spent},
                                   {"dropped", report.coins.dropped},
                                   {"balanced", report.coins.balanced()}}},
                                 {"ticks",
                                  {{"played", report.ticks},
                                   {"event_budget_overruns", world_overruns_of(report)},
                                   {"clock_overruns", report.clock_overruns},
                                   {"dropped", report.dropped_ticks},
                                   {"made_up_for", report.late_ticks},
                                   {"missed", report.late_ticks + report.dropped_ticks},
                                   {"p50_ms", 1e3 * durations.quantile_s(0.5)},
                                   {"p99_ms", 1e3 * durations.quantile_s(0.99)},
                                   {"max_ms", 1e3 * durations.max_s()}}},
                                 {"stages", stages_json_of(report)},
                                 {"cpu_s", run.cpu_s},
                                 {"player_ticks", report.player_ticks},
                                 {"traffic",
                                  {{"datagrams_sent", run.traffic.datagrams_sent},
                                   {"bytes_sent", run.traffic.bytes_sent},
                                   {"send_calls", run.traffic.send_calls},
                                   {"datagrams_received", run.traffic.datagrams_received},
                                   {"bytes_received", run.traffic.bytes_received},
                                   {"receive_calls", run.traffic.receive_calls}}},
                                 {"joins", report.joins},
                                 {"store_failures", report.store_failures},
                                 {"unwritten_transactions", report.unwritten_transactions},
                                 {"drops", report.drops}};
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

bool write_report(const std::string& path, const std::string& json, std::string& error) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file << json;
    file.close();
    if (file) return true;
    error = "cannot write the report to '" + path + "' (" + std::strerror(errno) +
            "); choose another file (--report)";
    return false;
}

}  // namespace fts::server
