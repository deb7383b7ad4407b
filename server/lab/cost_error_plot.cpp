#include "server/lab/cost_error_plot.h"

#include <algorithm>

#include "server/lab/pareto.h"

namespace fts::lab {
namespace {

bool of_one_series(const Setting& a, const Setting& b) {
    return a.solver.kind == b.solver.kind && a.scalar == b.scalar;
}

// The solver's name once, at the first of its points; then the substeps.
std::string label_of(const Setting& setting, bool first) {
    std::string steps =
        has_substeps(setting) ? "\u00d7" + std::to_string(setting.solver.substeps) : "";
    if (!first) return steps;
    std::string name(physics::to_string(setting.solver.kind));
    if (setting.scalar == physics::ScalarKind::kFloat) name += " float";
    return steps.empty() ? name : name + " " + steps;
}

}  // namespace

Series series_for(const Setting& setting) {
    Series series;
    switch (setting.solver.kind) {
        case physics::SolverKind::kSeed:
            series.ink = Ink::kPurple;
            series.marker = Marker::kTriangle;
            break;
        case physics::SolverKind::kDiscrete:
            series.ink = Ink::kOrange;
            series.marker = Marker::kSquare;
            break;
        case physics::SolverKind::kSwept:
            series.ink = Ink::kBlue;
            series.marker = Marker::kCircle;
            break;
        case physics::SolverKind::kEvent:
            series.ink = Ink::kGreen;
            series.marker = Marker::kDiamond;
            break;
    }
    series.hollow = series.dashed = setting.scalar == physics::ScalarKind::kFloat;
    return series;
}

Plot cost_error_plot(const std::vector<CostErrorPoint>& points) {
    Plot plot;
    plot.x = {"cost, ns per ball and tick", Scale::kLog, {}, {}};
    plot.y = {"collision error E", Scale::kLog, {}, {}};
    std::vector<CostAndError> choices;
    choices.reserve(points.size());
    for (const CostErrorPoint& point : points) choices.push_back({point.cost_ns, point.error});
    const auto front = pareto_front(choices);

    std::vector<bool> drawn(points.size(), false);
    for (std::size_t first = 0; first < points.size(); ++first) {
        if (drawn[first]) continue;
        Series series = series_for(points[first].setting);
        for (std::size_t i = first; i < points.size(); ++i) {
            if (!of_one_series(points[first].setting, points[i].setting)) continue;
            drawn[i] = true;
            const bool on_front = std::find(front.begin(), front.end(), i) != front.end();
            series.points.push_back({points[i].cost_ns, std::max(points[i].error, kLeastDrawnError),
                                     label_of(points[i].setting, i == first), on_front});
        }
        plot.series.push_back(std::move(series));
    }
    if (!front.empty()) {
        plot.front.emplace();
        plot.front->label = "Pareto front: nothing is both cheaper and more exact";
        for (const std::size_t i : front) {
            plot.front->points.push_back(
                {points[i].cost_ns, std::max(points[i].error, kLeastDrawnError), "", true});
        }
    }
    return plot;
}

}  // namespace fts::lab
