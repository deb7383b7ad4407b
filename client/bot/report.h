// What a run of bots comes to, as tables for a terminal and as JSON. Both use the metrics of
// tally.h; the JSON has them by name:
//   {"seconds": 30.0, "passed": true, "loop": {"mean_hz": 120.0, "longest_gap_ms": 9.1},
//    "total": {METRIC: number, ...},
//    "bots": [{"name": "bot-0", "ended_because": "", METRIC: number, ...}, ...],
//    "expectations": [{"expected": "...", "seen": "...", "met": true}, ...], "problems": ["..."]}
#pragma once

#include <span>
#include <string>
#include <vector>

#include "client/bot/expectations.h"
#include "client/bot/tally.h"

namespace fts::bot {

// With more bots than this the tables show all of them together only.
inline constexpr std::size_t kMaxBotsInTable = 16;

struct Report {
    double seconds = 0.0;
    // How often the bots were updated. Far below 120 Hz this machine was too slow for so many bots,
    // and what they measured of the network says little.
    double loop_mean_hz = 0.0;
    double cpu_s = 0.0;  // of the whole process
    double loop_longest_gap_s = 0.0;
    std::vector<Tally> tallies;
    std::vector<Verdict> verdicts;
    std::vector<std::string> problems;
    bool passed = false;
};

std::string as_tables(const Report& report);
std::string as_json(const Report& report);

}  // namespace fts::bot
