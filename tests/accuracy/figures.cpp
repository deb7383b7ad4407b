#include "tests/accuracy/figures.h"

#include <algorithm>
#include <cmath>

#include "server/lab/cost_error_plot.h"
#include "tests/accuracy/cells.h"
#include "tests/accuracy/study_scenes.h"

namespace fts::accuracy {
namespace {

using lab::Ink;
using lab::Marker;
using lab::Plot;
using lab::PlotPoint;
using lab::Scale;
using lab::Series;
using lab::Setting;
using physics::ScalarKind;
using physics::SolverKind;

constexpr const char* kCommand = "scripts/accuracy-study";
constexpr double kTradeSpeed = 0.1;
constexpr int kFewestCollisions = 32;

const char* kMediumGas = "100 equal balls in a periodic box, 30 % covered";

// What is drawn over speed: enough to see the order, few enough to be told apart.
std::vector<Setting> shown_settings() {
    return {{{SolverKind::kSeed, 1}, ScalarKind::kDouble},
            {{SolverKind::kDiscrete, 1}, ScalarKind::kDouble},
            {{SolverKind::kDiscrete, 4}, ScalarKind::kDouble},
            {{SolverKind::kDiscrete, 16}, ScalarKind::kDouble},
            {{SolverKind::kSwept, 1}, ScalarKind::kFloat},
            {{SolverKind::kEvent, 1}, ScalarKind::kFloat},
            {{SolverKind::kSwept, 1}, ScalarKind::kDouble},
            {{SolverKind::kEvent, 1}, ScalarKind::kDouble}};
}

std::string label_of(const Setting& setting) {
    std::string label(physics::to_string(setting.solver.kind));
    if (has_substeps(setting)) label += " \u00d7" + std::to_string(setting.solver.substeps);
    if (setting.scalar == ScalarKind::kFloat) label += " float";
    return label;
}

Series empty_series(const Setting& setting) {
    Series series = series_for(setting);
    series.label = label_of(setting);
    // Substeps of one solver share its colour, and differ in their markers.
    if (setting.solver.substeps == 4) series.marker = Marker::kDiamond;
    if (setting.solver.substeps == 16) series.marker = Marker::kTriangle;
    return series;
}

void add_point(Series& series, double x, const Json& cell, const char* field, double least = 0.0) {
    if (!cell.is_object() || !cell.contains(field) || !cell[field].is_number()) return;
    series.points.push_back({x, std::max(std::abs(cell[field].get<double>()), least), "", false});
}

Plot over_speed(const CellStore& cells, const std::string& scene, const char* field, double least) {
    Plot plot;
    plot.x = {"speed, radii per tick", Scale::kLog, {}, {}};
    plot.footnote = kCommand;
    for (const Setting& setting : shown_settings()) {
        Series series = empty_series(setting);
        for (const double speed : speeds()) {
            const bool is_cost = std::string(field) == "ns";
            const std::string key =
                is_cost ? cost_key(scene, speed, setting) : accuracy_key(scene, speed, setting);
            add_point(series, speed, cells.find(key), field, least);
        }
        plot.series.push_back(std::move(series));
    }
    return plot;
}

Figure trade(const CellStore& cells) {
    std::vector<lab::CostErrorPoint> points;
    for (const Setting& setting : all_settings()) {
        const Json accuracy = cells.find(accuracy_key("gas-medium", kTradeSpeed, setting));
        const Json cost = cells.find(cost_key("gas-medium", kTradeSpeed, setting));
        if (!accuracy.is_object() || !cost.is_object() || !accuracy["E"].is_number()) continue;
        points.push_back({setting, cost["ns"].get<double>(), accuracy["E"].get<double>()});
    }
    Plot plot = lab::cost_error_plot(points);
    plot.title = "What accuracy costs";
    plot.subtitle = std::string(kMediumGas) +
                    ", 0.1 radii a tick. Each mark is a solver; \u00d74 is four substeps a tick; "
                    "hollow marks are float. Down and to the left is better.";
    plot.footnote = kCommand;
    return {"accuracy-trade.svg", plot};
}

Figure error_of_a_pair(const CellStore& cells) {
    Plot plot = over_speed(cells, pairs_name(0.5), "E", lab::kLeastDrawnError);
    plot.y = {"collision error E", Scale::kLog, {}, {}};
    plot.title = "Two balls: a step is wrong in proportion to its length";
    plot.subtitle =
        "64 pairs of equal balls, one at rest; the other passes its centre at half the sum of "
        "radii. Open marks and dashed lines are float; no error at all is drawn at 1e-17.";
    plot.bands = {{0.7, 1e3, "as wrong as ignoring every collision"}};
    return {"accuracy-speed-pair.svg", plot};
}

Figure error_over_speed(const CellStore& cells) {
    Plot plot = over_speed(cells, "gas-medium", "E", 0.0);
    plot.y = {"collision error E", Scale::kLog, {}, {}};
    plot.title = "A crowd: who is hit twice in one step is wrong by a whole collision";
    plot.subtitle =
        std::string(kMediumGas) +
        ". Open marks and dashed lines are float. An exact solver's error is round-off, "
        "which each further collision of a ball in the same tick multiplies.";
    plot.bands = {{0.7, 1e3, "as wrong as ignoring every collision"}};
    return {"accuracy-speed.svg", plot};
}

Figure missed_over_speed(const CellStore& cells) {
    Plot plot = over_speed(cells, "gas-medium", "missed", 0.0);
    plot.y = {"missed collisions, of 1000 true ones", Scale::kLinear, 0.0, 1000.0};
    plot.title = "What steps do not see";
    plot.subtitle = std::string(kMediumGas) +
                    ". A collision is missed when the exact dynamics of the tick has it and the "
                    "solver has not.";
    return {"accuracy-missed.svg", plot};
}

Figure cost_over_speed(const CellStore& cells) {
    Plot plot = over_speed(cells, "gas-medium", "ns", 0.0);
    plot.y = {"cost, ns per ball and tick", Scale::kLog, {}, {}};
    plot.title = "Steps cost by the tick, events by the collision";
    plot.subtitle = std::string(kMediumGas) + ". The faster, the more collisions in a tick.";
    return {"accuracy-cost-speed.svg", plot};
}

Figure drift(const CellStore& cells) {
    Plot plot;
    plot.title = "Energy after so many collisions";
    plot.subtitle =
        "64 equal balls in a periodic box, 30 % covered, 0.1 radii a tick. No energy error at all "
        "is drawn at 1e-17.";
    plot.x = {"collisions", Scale::kLog, {}, {}};
    plot.y = {"relative error of the kinetic energy", Scale::kLog, {}, {}};
    plot.footnote = kCommand;
    for (const Setting& setting : drift_settings()) {
        Series series = empty_series(setting);
        const Json cell = cells.find(drift_key(setting));
        if (cell.is_object()) {
            for (const Json& point : cell["points"]) {
                const double error = std::abs(point[1].get<double>());
                series.points.push_back(
                    {point[0].get<double>(), std::max(error, 1e-17), "", false});
            }
        }
        plot.series.push_back(std::move(series));
    }
    return {"accuracy-drift.svg", plot};
}

// The median over the seeds, as collisions of one ball. An odd count has one in the middle.
std::optional<double> median_divergence(const CellStore& cells, std::size_t balls,
                                        const Setting& setting) {
    std::vector<double> collisions;
    for (std::uint64_t seed = 1; seed <= kDivergenceSeeds; ++seed) {
        const Json cell = cells.find(divergence_key(balls, seed, setting));
        if (cell.is_object()) collisions.push_back(cell["collisions"].get<double>());
    }
    if (collisions.size() < kDivergenceSeeds) return std::nullopt;
    std::sort(collisions.begin(), collisions.end());
    return 2.0 * collisions[collisions.size() / 2] / static_cast<double>(balls);
}

Figure divergence_over_size(const CellStore& cells) {
    Plot plot;
    plot.title = "How long a trajectory is the true one";
    plot.subtitle =
        "Gases of N equal balls, 30 % covered, 0.1 radii a tick: collisions of each ball until the "
        "first that the exact dynamics does not have. Medians of " +
        std::to_string(kDivergenceSeeds) + " gases.";
    plot.x = {"balls N", Scale::kLog, {}, {}};
    plot.y = {"collisions per ball until divergence", Scale::kLinear, 0.0, std::nullopt};
    plot.footnote = kCommand;
    for (const Setting& setting : divergence_settings()) {
        Series series = empty_series(setting);
        for (const std::size_t balls : divergence_sizes()) {
            const auto median = median_divergence(cells, balls, setting);
            if (median) series.points.push_back({static_cast<double>(balls), *median, "", false});
        }
        plot.series.push_back(std::move(series));
    }
    return {"accuracy-divergence.svg", plot};
}

Figure cost_over_size(const CellStore& cells) {
    Plot plot;
    plot.title = "What each ball costs in a crowd";
    plot.subtitle = "Gases of N equal balls, 30 % covered, 0.1 radii a tick.";
    plot.x = {"balls N", Scale::kLog, {}, {}};
    plot.y = {"cost, ns per ball and tick", Scale::kLog, {}, {}};
    plot.footnote = kCommand;
    for (const Setting& setting : size_settings()) {
        Series series = empty_series(setting);
        for (const std::size_t balls : cost_sizes()) {
            add_point(series, static_cast<double>(balls), cells.find(size_key(balls, setting)),
                      "ns");
        }
        plot.series.push_back(std::move(series));
    }
    return {"accuracy-cost-size.svg", plot};
}

Figure error_over_impact_parameter(const CellStore& cells) {
    Plot plot;
    plot.title = "Only a head-on hit forgives a late look";
    plot.subtitle =
        "64 pairs of equal balls, one at rest, at 0.1 radii a tick; b is how far the one passes "
        "the "
        "other's centre, over the sum of radii.";
    plot.x = {"impact parameter b", Scale::kLinear, 0.0, 1.0};
    plot.y = {"collision error E", Scale::kLog, {}, {}};
    plot.footnote = kCommand;
    for (const Setting& setting : shown_settings()) {
        Series series = empty_series(setting);
        for (const double parameter : impact_parameters()) {
            add_point(series, parameter,
                      cells.find(accuracy_key(pairs_name(parameter), 0.1, setting)), "E", 1e-17);
        }
        plot.series.push_back(std::move(series));
    }
    return {"accuracy-impact.svg", plot};
}

// E of pairs, over what is extreme about them. Where half of them do not even meet, for want of
// digits, there is nothing to tell.
Plot over_extreme(const CellStore& cells, const std::vector<double>& values,
                  std::string (*name_of)(double)) {
    Plot plot;
    plot.y = {"collision error E", Scale::kLog, {}, {}};
    plot.footnote = kCommand;
    for (const Setting& setting : shown_settings()) {
        Series series = empty_series(setting);
        for (const double value : values) {
            const Json cell = cells.find(accuracy_key(name_of(value), kExtremesSpeed, setting));
            if (!cell.is_object() || cell["collisions"] < kFewestCollisions) continue;
            add_point(series, value, cell, "E", lab::kLeastDrawnError);
        }
        plot.series.push_back(std::move(series));
    }
    return plot;
}

Figure error_over_mass_ratio(const CellStore& cells) {
    Plot plot = over_extreme(cells, mass_ratios(), pairs_of_mass_name);
    plot.title = "No mass is too small or too large";
    plot.subtitle =
        "64 pairs of balls at 0.1 radii a tick, the one at rest lighter or heavier than the "
        "other. No error at all is drawn at 1e-17.";
    plot.x = {"mass of the ball at rest over that of the other", Scale::kLog, {}, {}};
    return {"accuracy-mass.svg", plot};
}

Figure error_over_offset(const CellStore& cells) {
    Plot plot = over_extreme(cells, offsets_radii(), pairs_off_name);
    plot.title = "Far from the origin, places have fewer digits";
    plot.subtitle =
        "64 pairs of equal balls at 0.1 radii a tick, the whole scene moved away from the origin.";
    plot.x = {"distance along both axes, radii", Scale::kLog, {}, {}};
    plot.bands = {{0.7, 1e3, "as wrong as ignoring every collision"}};
    return {"accuracy-offset.svg", plot};
}

}  // namespace

std::vector<Figure> figures_of(const CellStore& cells) {
    return {trade(cells),
            error_of_a_pair(cells),
            error_over_speed(cells),
            error_over_impact_parameter(cells),
            missed_over_speed(cells),
            drift(cells),
            divergence_over_size(cells),
            cost_over_speed(cells),
            cost_over_size(cells),
            error_over_mass_ratio(cells),
            error_over_offset(cells)};
}

}  // namespace fts::accuracy
