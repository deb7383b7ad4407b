#include "client/bot/report.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include <nlohmann/json.hpp>

namespace fts::bot {
namespace {

using Rows = std::vector<std::vector<std::string>>;

// What each table shows, by the metrics' names; those about the own hits and the game first.
const std::vector<std::vector<std::string_view>> kTables = {
    {"joined", "knock_offs", "assists", "falls", "coins", "coins_spent", "purchases",
     "levels_cleared", "levels_lost", "hits", "worst_momentum_error", "worst_energy_error"},
    {"snapshots", "missed", "late", "loss", "rtt_mean_ms", "rtt_p99_ms", "delay_mean_ms", "starved",
     "inputs", "input_slack_ms", "inputs_late", "inputs_given_up"},
};

std::string cell(const Metric& metric, std::span<const Tally> tallies) {
    const double value = metric.value(tallies) * metric.scale;
    char text[48];
    if (metric.decimals < 0) {
        std::snprintf(text, sizeof text, "%.1e", value);
    } else {
        std::snprintf(text, sizeof text, "%.*f", metric.decimals, value);
    }
    return text;
}

std::vector<std::string> row(std::string label, const std::vector<std::string_view>& columns,
                             std::span<const Tally> tallies) {
    std::vector<std::string> cells{std::move(label)};
    for (const std::string_view name : columns) cells.push_back(cell(*metric_named(name), tallies));
    return cells;
}

// In characters, so that names with letters beyond ASCII line up as well.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::ranges::count_if(
        text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string aligned(const Rows& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const auto& cells : rows) {
        for (std::size_t i = 0; i < cells.size(); ++i) {
            widths[i] = std::max(widths[i], width_of(cells[i]));
        }
    }
    std::string text;
    for (const auto& cells : rows) {
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const std::string gap(widths[i] - width_of(cells[i]), ' ');
            text += i == 0 ? cells[i] + gap : "  " + gap + cells[i];
        }
        text += '\n';
    }
    return text;
}

std::string table(const std::vector<std::string_view>& columns, std::span<const Tally> tallies) {
    Rows rows;
    rows.push_back({"bot"});
    for (const std::string_view name : columns) {
        rows.back().emplace_back(metric_named(name)->title);
    }
    if (tallies.size() <= kMaxBotsInTable) {
        for (std::size_t i = 0; i < tallies.size(); ++i) {
            rows.push_back(row(tallies[i].name, columns, tallies.subspan(i, 1)));
        }
    }
    rows.push_back(row("all " + std::to_string(tallies.size()), columns, tallies));
    return aligned(rows);
}

// "3 x No answer from ...", the most frequent reasons being few.
std::string reasons(std::span<const Tally> tallies) {
    std::map<std::string, int> counts;
    for (const Tally& tally : tallies) {
        if (!tally.ended_because.empty()) ++counts[tally.ended_because];
    }
    std::string text;
    for (const auto& [reason, count] : counts) {
        text += "Ended, " + std::to_string(count) + (count == 1 ? " bot:  " : " bots: ") + reason +
                "\n";
    }
    return text;
}

std::string verdict_lines(const std::vector<Verdict>& verdicts) {
    std::string text;
    for (const Verdict& verdict : verdicts) {
        text += (verdict.met ? "met      " : "NOT MET  ") + verdict.expected + "; seen " +
                verdict.seen + "\n";
    }
    return text;
}

nlohmann::ordered_json metrics_of(std::span<const Tally> tallies) {
    nlohmann::ordered_json values = nlohmann::ordered_json::object();
    for (const Metric& metric : metrics()) {
        values[std::string(metric.name)] = metric.value(tallies);
    }
    return values;
}

}  // namespace

std::string as_tables(const Report& report) {
    char summary[160];
    std::snprintf(
        summary, sizeof summary,
        "%zu %s played for %.1f s, updated at %.0f Hz (longest gap %.0f ms), CPU %.1f s\n",
        report.tallies.size(), report.tallies.size() == 1 ? "bot" : "bots", report.seconds,
        report.loop_mean_hz, report.loop_longest_gap_s * 1e3, report.cpu_s);
    const bool anybody_joined = std::ranges::any_of(report.tallies, &Tally::joined);
    std::string text = anybody_joined ? summary : "No bot could join.\n";
    for (const auto& columns : kTables) {
        if (anybody_joined) text += "\n" + table(columns, report.tallies);
    }
    const std::string ended = reasons(report.tallies);
    if (!ended.empty()) text += "\n" + ended;
    if (!report.verdicts.empty()) text += "\n" + verdict_lines(report.verdicts);
    for (const std::string& problem : report.problems) text += "\n" + problem + "\n";
    return text;
}

std::string as_json(const Report& report) {
    nlohmann::ordered_json root;
    root["seconds"] = report.seconds;
    root["passed"] = report.passed;
    root["cpu_s"] = report.cpu_s;
    root["loop"] = {{"mean_hz", report.loop_mean_hz},
                    {"longest_gap_ms", report.loop_longest_gap_s * 1e3}};
    root["total"] = metrics_of(report.tallies);
    root["bots"] = nlohmann::ordered_json::array();
    const std::span<const Tally> tallies = report.tallies;
    for (std::size_t i = 0; i < tallies.size(); ++i) {
        nlohmann::ordered_json bot;
        bot["name"] = tallies[i].name;
        bot["ended_because"] = tallies[i].ended_because;
        bot.update(metrics_of(tallies.subspan(i, 1)));
        root["bots"].push_back(std::move(bot));
    }
    root["expectations"] = nlohmann::ordered_json::array();
    for (const Verdict& verdict : report.verdicts) {
        root["expectations"].push_back(
            {{"expected", verdict.expected}, {"seen", verdict.seen}, {"met", verdict.met}});
    }
    root["problems"] = report.problems;
    return root.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fts::bot
