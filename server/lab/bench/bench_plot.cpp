// Results as a chart of cost.
#include <algorithm>

#include "server/lab/bench/bench.h"
#include "server/lab/cost_error_plot.h"

namespace fts::lab {
namespace {

// Solvers look as they do in every chart; float is hollow and dashed.
Series series_of_engine(const EngineInfo& engine) {
    Series series;
    const std::size_t dash = engine.name.rfind('-');
    if (engine.is_floor) {
        series.ink = Ink::kGrey;
        series.marker = Marker::kNone;
        series.dashed = engine.name.ends_with("float");
    } else if (const auto solver = physics::solver_from(engine.name.substr(0, dash))) {
        const bool is_float = engine.name.ends_with("float");
        series = series_for(
            {{*solver, 1}, is_float ? physics::ScalarKind::kFloat : physics::ScalarKind::kDouble});
    } else {
        const bool is_box2d = engine.name.starts_with("box2d");
        const bool is_first = engine.name == "box2d" || engine.name == "chipmunk-hash";
        series.ink = is_box2d ? Ink::kVermillion : Ink::kBlack;
        series.marker = is_first ? Marker::kTriangle : Marker::kDiamond;
    }
    series.label = engine.title;
    return series;
}

double& coordinate(BenchScene& scene, BenchAxis axis, double& balls) {
    switch (axis) {
        case BenchAxis::kPacking:
            return scene.packing;
        case BenchAxis::kSpeed:
            return scene.radii_per_tick;
        case BenchAxis::kBalls:
            break;
    }
    return balls;
}

// Where on the axis the scene is; empty when it differs from `fixed` in something else, too.
std::optional<double> place_on(BenchAxis axis, BenchScene scene, const BenchScene& fixed) {
    auto balls = static_cast<double>(scene.balls);
    double& ours = coordinate(scene, axis, balls);
    const double place = ours;
    BenchScene other = fixed;
    double ignored = 0.0;
    ours = coordinate(other, axis, ignored);
    if (axis == BenchAxis::kBalls) scene.balls = other.balls;
    if (scene == other) return place;
    return std::nullopt;
}

}  // namespace

Plot cost_plot(const std::vector<BenchResult>& results, BenchAxis axis, const BenchScene& fixed) {
    Plot plot;
    switch (axis) {
        case BenchAxis::kBalls:
            plot.x = {"balls", Scale::kLog, {}, {}};
            break;
        case BenchAxis::kPacking:
            plot.x = {"packing: part of the area that balls cover", Scale::kLinear, 0.0, {}};
            break;
        case BenchAxis::kSpeed:
            plot.x = {"speed, radii per tick", Scale::kLog, {}, {}};
            break;
    }
    plot.y = {"ns per ball and tick", Scale::kLog, {}, {}};
    for (const EngineInfo& engine : engines()) {
        Series series = series_of_engine(engine);
        for (const BenchResult& result : results) {
            if (result.cell.engine != engine.name || !result.not_run.empty()) continue;
            const auto place = place_on(axis, result.cell.scene, fixed);
            if (place) series.points.push_back({*place, result.ns_per_ball_tick, "", false});
        }
        std::ranges::sort(series.points, {}, &PlotPoint::x);
        if (!series.points.empty()) plot.series.push_back(std::move(series));
    }
    return plot;
}

}  // namespace fts::lab
