// A comparison as a table for the terminal.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "server/lab/compare.h"
#include "server/lab/digits.h"
#include "server/lab/text_table.h"

namespace fts::lab {
namespace {

std::string error_text(const std::optional<double>& value) {
    if (!value) return "-";
    if (*value == 0.0) return "0";
    return with_digits("%.1e", std::abs(*value));
}

std::string short_text(const std::optional<double>& value) {
    if (!value) return "-";
    return with_digits(std::abs(*value) < 10.0 ? "%.3g" : "%.0f", *value);
}

std::string divergence_text(const std::optional<Divergence>& divergence) {
    if (!divergence) return "-";
    return (divergence->reached ? "" : ">=") + std::to_string(divergence->collisions);
}

std::vector<std::string> cells_of(const CompareRow& row) {
    const LocalAccuracy& local = row.accuracy.local;
    const GlobalAccuracy& global = row.accuracy.global;
    const std::string name = (row.pareto ? "* " : "  ") + to_string(row.setting);
    if (!row.skipped.empty()) return {name, "-", "-", "-", "-", "-", "-", "-", "-", "-", "-", "-"};
    return {name,
            with_digits("%.1f", row.cost.ns_per_body_tick),
            with_digits("%.2g", row.cost.collisions_per_s),
            error_text(local.collision_error),
            short_text(local.missed_per_1000()),
            short_text(local.extra_per_1000()),
            error_text(local.time_error_ticks),
            error_text(local.angle_error_deg),
            error_text(global.penetration_over_r),
            error_text(global.energy_error),
            error_text(global.momentum_error),
            divergence_text(global.divergence)};
}

// What is said of several rows is said once.
void add_remarks(const Comparison& comparison, std::string& out) {
    std::vector<std::string> said;
    for (const CompareRow& row : comparison.rows) {
        for (const std::string& remark : row.accuracy.remarks) {
            std::size_t rows = 0;
            for (const CompareRow& other : comparison.rows) {
                for (const std::string& theirs : other.accuracy.remarks) rows += theirs == remark;
            }
            const std::string line =
                (rows > 1 ? "" : to_string(row.setting) + ": ") + remark + "\n";
            if (std::find(said.begin(), said.end(), line) == said.end()) said.push_back(line);
        }
        if (!row.skipped.empty()) {
            said.push_back(to_string(row.setting) + " is left out: " + row.skipped + "\n");
        }
    }
    for (const std::string& line : said) out += line;
}

}  // namespace

std::string table_of(const CompareRequest& request, const Comparison& comparison) {
    TextTable table({"  solver", "ns", "hits/s", "E", "missed", "extra", "time", "angle", "depth",
                     "energy", "momentum", "true for"});
    std::size_t samples = 0, ticks = 0;
    for (const CompareRow& row : comparison.rows) {
        table.add(cells_of(row));
        samples = std::max(samples, row.accuracy.local.collisions);
        ticks = std::max(ticks, row.accuracy.local.ticks);
    }
    char head[200];
    std::snprintf(head, sizeof head, ": %zu bodies, %g s at %g Hz (%zu ticks)\n\n",
                  request.scene.bodies.size(), request.seconds, request.rate_hz,
                  comparison.run.ticks);
    std::string out = request.scene_name + head + table.text() + "\n";
    out +=
        "  *         Pareto-optimal: none is both cheaper (ns) and more exact (E)\n"
        "  ns        cost per body and tick; hits/s: collisions per second of computing\n"
        "  E         collision error of single ticks against the oracle: 0 exact, about 1 as if\n"
        "            every collision were ignored\n"
        "  missed, extra   collisions per 1000 true ones\n"
        "  time      of impact, rms error in ticks; angle: of deflection, rms error in degrees\n"
        "  depth     deepest penetration over the radius\n"
        "  energy, momentum   relative errors at the end\n"
        "  true for  collisions until the trajectory leaves the oracle's\n";
    char foot[160];
    std::snprintf(
        foot, sizeof foot,
        "  Local figures from up to %zu collisions in %zu ticks a row; cost the median of %u.\n",
        samples, ticks, request.cost.repeats);
    out += foot;
    add_remarks(comparison, out);
    out += "Again: " + comparison.command + "\n";
    if (!comparison.rows.empty()) {
        out += "One row: " + comparison.rows.front().command + "\n";
    }
    if (comparison.stopped()) {
        out += "stopped after " + std::to_string(comparison.done) + " of " +
               std::to_string(comparison.of) + "\n";
    }
    return out;
}

}  // namespace fts::lab
