// The chart of the trade: cost against collision error, the Pareto front marked.
#pragma once

#include <string>
#include <vector>

#include "server/lab/setting.h"
#include "server/lab/svg_plot.h"

namespace fts::lab {

// An error of 0 has no place on a logarithmic axis and is drawn here.
inline constexpr double kLeastDrawnError = 1e-17;

struct CostErrorPoint {
    Setting setting;
    double cost_ns = 0.0;
    double error = 0.0;
};

// How a solver is drawn everywhere: its colour and marker. Float is hollow and dashed.
Series series_for(const Setting& setting);

// Settings that differ in their substeps only are joined by a line, in the order given. Title,
// subtitle and footnote are the caller's to add.
Plot cost_error_plot(const std::vector<CostErrorPoint>& points);

}  // namespace fts::lab
