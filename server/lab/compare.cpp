#include "server/lab/compare.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "server/lab/digits.h"
#include "server/lab/pareto.h"

namespace fts::lab {
namespace {

// A solver that would take longer than this for the run is left out.
constexpr double kMaxSecondsOfARow = 60.0;
// What `seed` needs at least to look at one pair, to know before the first tick.
constexpr double kLeastSecondsOfAPair = 1e-9;

std::string command_for(const CompareRequest& request) {
    return "fts-lab compare " + request.scene_name + " --seconds " +
           with_digits("%.6g", request.seconds) + " --rate " + with_digits("%.6g", request.rate_hz);
}

// Why a row would take minutes; empty when it would not.
std::string reason_to_skip(double seconds_of_a_tick, const Run& run, bool all_pairs) {
    // The run is made twice: followed to its end, and sampled.
    const double seconds = 2.0 * seconds_of_a_tick * static_cast<double>(run.ticks);
    if (seconds <= kMaxSecondsOfARow) return {};
    char text[160];
    std::snprintf(text, sizeof text, "%s%.0f ticks would take about %.0f min; give less --seconds",
                  all_pairs ? "it looks at every pair: " : "", static_cast<double>(run.ticks),
                  std::ceil(seconds / 60.0));
    return text;
}

std::string skip_before_timing(const CompareRequest& request, const Setting& setting,
                               const Run& run) {
    if (setting.solver.kind != physics::SolverKind::kSeed) return {};
    const auto bodies = static_cast<double>(request.scene.bodies.size());
    const double pairs = 0.5 * bodies * bodies * setting.solver.substeps;
    return reason_to_skip(pairs * kLeastSecondsOfAPair, run, true);
}

// False when stopped.
bool measure_row(const CompareRequest& request, const Run& run, const Reference* reference,
                 const KeepGoing& keep_going, CompareRow& row) {
    row.skipped = skip_before_timing(request, row.setting, run);
    if (!row.skipped.empty()) return true;
    const auto cost = measure_cost(request.scene, row.setting, run, request.cost, keep_going);
    if (!cost) {
        row.skipped = "there is nothing to time";
        return keep_going();
    }
    row.cost = *cost;
    const double seconds_of_a_tick =
        1e-9 * cost->ns_per_body_tick * static_cast<double>(request.scene.bodies.size());
    const bool all_pairs = row.setting.solver.kind == physics::SolverKind::kSeed;
    row.skipped = reason_to_skip(seconds_of_a_tick, run, all_pairs);
    if (!row.skipped.empty()) return true;
    const auto accuracy =
        measure_accuracy(request.scene, row.setting, run, request.sampling, reference, keep_going);
    if (!accuracy) return false;
    row.accuracy = *accuracy;
    return true;
}

void sort_and_mark(std::vector<CompareRow>& rows) {
    std::stable_sort(rows.begin(), rows.end(), [](const CompareRow& a, const CompareRow& b) {
        if (a.skipped.empty() != b.skipped.empty()) return a.skipped.empty();
        return a.cost.ns_per_body_tick < b.cost.ns_per_body_tick;
    });
    std::vector<CostAndError> choices;
    for (const CompareRow& row : rows) {
        const bool counts = row.skipped.empty() && row.accuracy.global.finite;
        choices.push_back(
            {row.cost.ns_per_body_tick,
             counts ? row.accuracy.local.collision_error.value_or(std::nan("")) : std::nan("")});
    }
    for (const std::size_t i : pareto_front(choices)) rows[i].pareto = true;
}

}  // namespace

std::vector<Setting> settings_of(const CompareRequest& request) {
    std::vector<Setting> settings;
    for (const physics::SolverKind kind : request.solvers) {
        const bool stepped = has_substeps({{kind, 1}, physics::ScalarKind::kDouble});
        for (const std::uint32_t substeps :
             stepped ? request.substeps : std::vector<std::uint32_t>{1}) {
            for (const physics::ScalarKind scalar : request.scalars) {
                settings.push_back({{kind, substeps}, scalar});
            }
        }
    }
    return settings;
}

Comparison compare(const CompareRequest& request, const KeepGoing& keep_going,
                   const std::function<void(std::size_t, std::size_t, const Setting&)>& progress) {
    Comparison comparison;
    comparison.run = {static_cast<std::size_t>(std::llround(request.seconds * request.rate_hz)),
                      1.0 / request.rate_hz};
    comparison.command = command_for(request);
    const auto settings = settings_of(request);
    comparison.of = settings.size();
    if (!settings.empty()) progress(0, settings.size(), settings.front());
    const auto reference =
        reference_of(request.scene, comparison.run, request.sampling, keep_going);
    for (const Setting& setting : settings) {
        if (!keep_going()) break;
        progress(comparison.done, comparison.of, setting);
        CompareRow row;
        row.setting = setting;
        row.command = comparison.command + " " + flags_of(setting);
        if (!measure_row(request, comparison.run, reference ? &*reference : nullptr, keep_going,
                         row)) {
            break;
        }
        comparison.rows.push_back(std::move(row));
        ++comparison.done;
    }
    sort_and_mark(comparison.rows);
    return comparison;
}

}  // namespace fts::lab
