// A comparison as a picture.
#include <algorithm>
#include <cstdio>

#include "server/lab/compare.h"
#include "server/lab/cost_error_plot.h"
#include "server/lab/svg_plot.h"

namespace fts::lab {

std::string svg_of(const CompareRequest& request, const Comparison& comparison) {
    std::vector<CostErrorPoint> points;
    std::size_t most = 0;
    bool zero = false;
    for (const CompareRow& row : comparison.rows) {
        const LocalAccuracy& local = row.accuracy.local;
        if (!row.skipped.empty() || !local.collision_error) continue;
        points.push_back({row.setting, row.cost.ns_per_body_tick, *local.collision_error});
        most = std::max(most, local.collisions);
        zero = zero || *local.collision_error == 0.0;
    }
    if (points.empty()) return {};
    // Lines join what differs in substeps only, in ascending order.
    std::stable_sort(points.begin(), points.end(),
                     [](const CostErrorPoint& a, const CostErrorPoint& b) {
                         return a.setting.solver.substeps < b.setting.solver.substeps;
                     });
    Plot plot = cost_error_plot(points);
    plot.title = "Speed for accuracy: " + request.scene_name;
    char text[400];
    std::snprintf(text, sizeof text,
                  "%zu bodies, %g s at %g Hz. E: how wrong velocities are after a tick with "
                  "collisions, as a part of the speed, from up to %zu collisions a mark; about 1 "
                  "is as wrong as ignoring them. Hollow marks are float.%s",
                  request.scene.bodies.size(), request.seconds, request.rate_hz, most,
                  zero ? " No error at all is drawn at 1e-17." : "");
    plot.subtitle = text;
    plot.footnote = comparison.command;
    if (comparison.stopped()) {
        plot.footnote += "   (stopped after " + std::to_string(comparison.done) + " of " +
                         std::to_string(comparison.of) + ")";
    }
    return render_svg(plot);
}

}  // namespace fts::lab
