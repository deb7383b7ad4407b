// Whether a run turned out as its script expects.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "client/bot/script.h"
#include "client/bot/tally.h"

namespace fts::bot {

struct Verdict {
    std::string expected;  // "coins of bot 0 at least 5"
    std::string seen;      // "3"
    bool met = false;
};

// One for each expectation, in order.
std::vector<Verdict> judge(const std::vector<Expectation>& expectations,
                           std::span<const Tally> tallies);
// Whether every goal is reached; false when there are none.
bool reached(const std::vector<Goal>& goals, std::span<const Tally> tallies);
// Whether a run in which nobody got in can be as its script expects: it speaks of who joins, or of
// why sessions ended.
bool minds_who_joins(const std::vector<Expectation>& expectations);

}  // namespace fts::bot
