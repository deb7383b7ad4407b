// Tally: what one bot counted, and the metrics that reports, expectations and scripts call it by.
// The table of metrics is the one place where a name is given a meaning.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "client/bot/rtt_histogram.h"
#include "client/core/session.h"

namespace fts::bot {

struct Tally {
    std::string name;
    bool joined = false;           // ever
    std::string ended_because;     // empty while the session goes on
    client::SessionStats session;  // over all sessions of this bot
    RttHistogram rtt;
    double delay_sum_s = 0.0;
    double input_slack_sum_s = 0.0;
    std::uint64_t delay_samples = 0;  // of either
    int knock_offs = 0, assists = 0, falls = 0, coins = 0;
    int coins_spent = 0;
    int purchases = 0, purchases_refused = 0;
    int levels_started = 0, levels_cleared = 0, levels_lost = 0;
    int highest_level = 0;
    int chat_lines = 0;
    std::uint64_t hits = 0, hits_malformed = 0;
    double worst_momentum_error = 0.0, worst_energy_error = 0.0;
};

struct Metric {
    std::string_view name;   // in JSON, expectations and "until"
    std::string_view title;  // in the table
    std::string_view about;
    int decimals = 0;    // in the table; -1: scientific
    double scale = 1.0;  // of the table's number, e.g. 100 for a share in percent
    // Of one bot, or of several together.
    double (*value)(std::span<const Tally>) = nullptr;
};

std::span<const Metric> metrics();
// nullptr when there is none of that name.
const Metric* metric_named(std::string_view name);

}  // namespace fts::bot
