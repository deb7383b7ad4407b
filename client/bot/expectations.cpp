#include "client/bot/expectations.h"

#include <algorithm>
#include <cassert>
#include <string>

#include "client/bot/json_reader.h"

namespace fts::bot {
namespace {

std::string whose(const Expectation& expectation) {
    return expectation.bot ? " of bot " + std::to_string(*expectation.bot) : "";
}

Verdict judge_reason(const Expectation& expectation, std::span<const Tally> tallies) {
    Verdict verdict;
    verdict.expected =
        expectation.what + whose(expectation) + " contains \"" + expectation.contains + "\"";
    for (const Tally& tally : tallies) {
        verdict.met |= tally.ended_because.find(expectation.contains) != std::string::npos;
    }
    // One reason stands for all when it does not matter which bot is meant.
    const auto first = std::ranges::find_if(
        tallies, [](const Tally& tally) { return !tally.ended_because.empty(); });
    verdict.seen = first == tallies.end() ? "no session ended" : "\"" + first->ended_because + "\"";
    return verdict;
}

Verdict judge_metric(const Expectation& expectation, std::span<const Tally> tallies) {
    const Metric* metric = metric_named(expectation.what);
    assert(metric != nullptr);
    const double seen = metric->value(tallies);
    Verdict verdict;
    verdict.expected = expectation.what + whose(expectation);
    verdict.met = true;
    if (expectation.at_least) {
        verdict.expected += " at least " + in_words(*expectation.at_least);
        verdict.met = verdict.met && seen >= *expectation.at_least;
    }
    if (expectation.at_most) {
        verdict.expected += " at most " + in_words(*expectation.at_most);
        verdict.met = verdict.met && seen <= *expectation.at_most;
    }
    verdict.seen = in_words(seen);
    return verdict;
}

}  // namespace

std::vector<Verdict> judge(const std::vector<Expectation>& expectations,
                           std::span<const Tally> tallies) {
    std::vector<Verdict> verdicts;
    for (const Expectation& expectation : expectations) {
        const auto meant = expectation.bot
                               ? tallies.subspan(static_cast<std::size_t>(*expectation.bot), 1)
                               : tallies;
        verdicts.push_back(expectation.what == kEndedBecause ? judge_reason(expectation, meant)
                                                             : judge_metric(expectation, meant));
    }
    return verdicts;
}

bool reached(const std::vector<Goal>& goals, std::span<const Tally> tallies) {
    return !goals.empty() && std::ranges::all_of(goals, [&](const Goal& goal) {
        return metric_named(goal.metric)->value(tallies) >= goal.at_least;
    });
}

bool minds_who_joins(const std::vector<Expectation>& expectations) {
    return std::ranges::any_of(expectations, [](const Expectation& expectation) {
        return expectation.what == "joined" || expectation.what == kEndedBecause;
    });
}

}  // namespace fts::bot
