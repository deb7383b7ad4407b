// What a study of interpolation found: for the terminal, for programs, and as a picture.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "server/lab/arena_trace.h"
#include "server/lab/interpolation_study.h"
#include "server/lab/svg_plot.h"
#include "server/lab/text_table.h"

namespace fts::lab {
namespace {

// Half a step of the lattice each way: how far a snapshot may be from the truth.
double rounding_radii(const InterpolationStudy& study) {
    return kTraceLattice.position_step_m * std::sqrt(0.5) / study.radius_m;
}

// So that a radius is as long on both axes.
constexpr double kHitPlotHalfWidth = 4.1, kHitPlotHalfHeight = 1.9;

DrawnHit::Path outline_of(const physics::Vec2d& centre_m, double radius_m) {
    constexpr int kCorners = 96;
    DrawnHit::Path path;
    for (int corner = 0; corner <= kCorners; ++corner) {
        const double angle = 2.0 * std::numbers::pi * corner / kCorners;
        path.push_back(centre_m + radius_m * physics::Vec2d(std::cos(angle), std::sin(angle)));
    }
    return path;
}

Ink ink_of(std::string_view way) {
    return way == kStraightWay  ? Ink::kGrey
           : way == kHermiteWay ? Ink::kOrange
           : way == kBlindWay   ? Ink::kBlue
           : way == kToldWay    ? Ink::kGreen
                                : Ink::kPurple;
}

}  // namespace

std::string command_of(const InterpolationRequest& request) {
    return fmt::format("fts-lab interpolation --count {} --seed {} --seconds {:g}", request.count,
                       request.seed, request.seconds);
}

std::string table_of(const InterpolationRequest& request, const InterpolationStudy& study) {
    TextTable table({"way", "Hz", "mean r", "p99 r", "max r", "us/ball"});
    for (const InterpolationRow& row : study.rows) {
        table.add({row.way, std::to_string(row.rate_hz), fmt::format("{:.4f}", row.mean),
                   fmt::format("{:.4f}", row.p99), fmt::format("{:.2f}", row.max),
                   row.us_per_ball > 0.0 ? fmt::format("{:.2f}", row.us_per_ball) : "-"});
    }
    std::string out = fmt::format("{} balls, {:g} frames a second beside the server's truth\n\n",
                                  request.count, kFrameRateHz);
    out += table.text() + "\n";
    out += fmt::format(
        "  Hz         snapshots a second\n"
        "  r          error in radii of a ball, {:.3f} m; rounding a snapshot is up to {:.3f} r\n"
        "  us/ball    of processor time to make a path, once for two snapshots\n"
        "  lattice    the server keeps its own state on the snapshots' lattice\n",
        study.radius_m, rounding_radii(study));
    out += "Again: " + command_of(request) + "\n";
    if (study.stopped()) out += fmt::format("stopped after {} of {}\n", study.done, study.of);
    return out;
}

std::string json_of(const InterpolationRequest& request, const InterpolationStudy& study) {
    nlohmann::ordered_json json = {{"count", request.count},
                                   {"seed", request.seed},
                                   {"seconds", request.seconds},
                                   {"unmeasured_s", kUnmeasuredS},
                                   {"frame_rate_hz", kFrameRateHz},
                                   {"radius_m", study.radius_m},
                                   {"rounding_radii", rounding_radii(study)},
                                   {"command", command_of(request)},
                                   {"snapshots", study.done},
                                   {"stopped", study.stopped()}};
    json["rows"] = nlohmann::ordered_json::array();
    for (const InterpolationRow& row : study.rows) {
        json["rows"].push_back({{"way", row.way},
                                {"rate_hz", row.rate_hz},
                                {"mean_radii", row.mean},
                                {"p99_radii", row.p99},
                                {"max_radii", row.max},
                                {"samples", row.samples},
                                {"us_per_ball", row.us_per_ball}});
    }
    return json.dump(2) + "\n";
}

std::string svg_of(const InterpolationRequest& request, const InterpolationStudy& study) {
    Plot plot;
    plot.title = "How far what is drawn is from what happened";
    plot.subtitle = fmt::format(
        "{} balls, {:g} % of them steered, at {:g} frames a second. Of 100 balls 99 are drawn "
        "closer to where the server had them than the line says.",
        request.count, 100.0 * kTraceSteeredPart, kFrameRateHz);
    plot.footnote = command_of(request);
    plot.x = {"snapshots a second", Scale::kLog, 8.0, 75.0};
    plot.y = {"error, radii of a ball: 99 of 100 below", Scale::kLog, 0.01, {}};
    plot.bands.push_back({0.01, rounding_radii(study), {}});
    plot.notes.push_back({13.0, 0.0135, "no further off than rounding puts a snapshot"});
    for (const InterpolationRow& row : study.rows) {
        auto series = std::ranges::find(plot.series, row.way, &Series::label);
        if (series == plot.series.end()) {
            Series added;
            added.label = row.way;
            added.ink = ink_of(row.way);
            added.marker = row.way.starts_with("ours") ? Marker::kCircle : Marker::kSquare;
            series = plot.series.insert(plot.series.end(), std::move(added));
        }
        series->points.push_back({static_cast<double>(row.rate_hz), row.p99, {}});
    }
    return render_svg(plot);
}

std::string hit_svg_of(const InterpolationRequest& request, const InterpolationStudy& study) {
    if (!study.worst_hit) return {};
    const DrawnHit& hit = *study.worst_hit;
    const physics::Vec2d middle_m = (hit.a.hit_m + hit.b.hit_m) / 2.0;
    // Turned so that both come along the page.
    const physics::Vec2d closing_m =
        (hit.a.hit_m - hit.a.truth.front()) - (hit.b.hit_m - hit.b.truth.front());
    const physics::Vec2d along = closing_m.normalized();
    const auto point_of = [&](const physics::Vec2d& place_m) {
        const physics::Vec2d from_middle = (place_m - middle_m) / study.radius_m;
        return PlotPoint{
            along.dot(from_middle), along.x() * from_middle.y() - along.y() * from_middle.x(), {}};
    };
    Plot plot;
    plot.title = "One hit, and how it is drawn";
    plot.subtitle = fmt::format(
        "Of the hits about halfway between two of {} snapshots a second that turn both balls, the "
        "one that straight lines miss most. Circles: the balls when they touched; dashed: the "
        "server's paths.",
        kDrawnHitRateHz);
    plot.footnote = command_of(request) + " --hit-svg FILE";
    plot.x = {"radii of a ball", Scale::kLinear, -kHitPlotHalfWidth, kHitPlotHalfWidth};
    plot.y = {"radii of a ball", Scale::kLinear, -kHitPlotHalfHeight, kHitPlotHalfHeight};
    const auto draw = [&](const DrawnHit::Path& path, Ink ink, std::string_view label,
                          double label_at) {
        Series series;
        series.ink = ink;
        series.marker = Marker::kNone;
        series.dashed = ink == Ink::kBlack;
        for (const physics::Vec2d& place_m : path) series.points.push_back(point_of(place_m));
        const auto labelled = static_cast<std::size_t>(label_at * double(path.size() - 1));
        series.points[labelled].label = label;
        plot.series.push_back(std::move(series));
    };
    for (const DrawnHit::Ball* ball : {&hit.a, &hit.b}) {
        draw(outline_of(ball->hit_m, study.radius_m), Ink::kGrey, {}, 0.0);
        draw(ball->straight, Ink::kGrey, kStraightWay, 0.5);
        draw(ball->smooth, Ink::kOrange, kHermiteWay, 0.5);
        draw(ball->blind, Ink::kBlue, kBlindWay, 0.3);
        draw(ball->truth, Ink::kBlack, {}, 0.0);
    }
    return render_svg(plot);
}

}  // namespace fts::lab
