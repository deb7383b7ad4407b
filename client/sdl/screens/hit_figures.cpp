#include <algorithm>
#include <array>
#include <cmath>

#include "client/sdl/draw_balls.h"
#include "client/sdl/screens/inspector.h"
#include "client/sdl/wording.h"

namespace fts::sdl {
namespace {

using Hit = replication::CollisionReport;
using physics::Vec2d;

constexpr double kBeforeOpacity = 0.42;

// Maps metres around the point of contact into a box, y up.
struct Frame {
    ImVec2 centre;
    Vec2d middle_m;
    double scale;  // pixels per metre

    ImVec2 at(const Vec2d& point_m) const {
        const Vec2d offset = (point_m - middle_m) * scale;
        return {centre.x + static_cast<float>(offset.x()),
                centre.y - static_cast<float>(offset.y())};
    }
    float px(double length_m) const { return static_cast<float>(length_m * scale); }
};

// The frame in which discs at `points` fit the box.
template <std::size_t Count>
Frame fitted(const Box& box, const std::array<Vec2d, Count>& points, double margin_m) {
    Vec2d low = points[0], high = points[0];
    for (const Vec2d& point : points) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    low.array() -= margin_m;
    high.array() += margin_m;
    const Vec2d extent = (high - low).cwiseMax(1e-6);
    const double scale = std::min(static_cast<double>(box.width()) / extent.x(),
                                  static_cast<double>(box.height()) / extent.y());
    return {box.centre(), (low + high) / 2.0, scale};
}

double fastest_mps(const Hit& hit) {
    return std::max({hit.own.velocity_before_mps.norm(), hit.own.velocity_after_mps.norm(),
                     hit.other.velocity_before_mps.norm(), hit.other.velocity_after_mps.norm(),
                     1e-3});
}

void label(const Canvas& canvas, ImVec2 at, Colour colour, const std::string& text,
           Align align = Align::kCentre) {
    canvas.text_middle(at, TextStyle::kCaption, colour, text, align);
}

void draw_path(const Canvas& canvas, const Frame& frame, const Hit::Side& side, Colour colour,
               double span_s) {
    const Vec2d before_m = side.position_m - side.velocity_before_mps * span_s;
    const ImVec2 origin = frame.at(before_m), contact = frame.at(side.position_m);
    const float radius = frame.px(side.radius_m);
    if (side.velocity_before_mps.norm() * span_s > side.radius_m * 0.25) {
        canvas.list->AddCircleFilled(origin, radius, fade(colour, 0.13), segments_for(radius));
        canvas.ring(origin, radius, fade(colour, kBeforeOpacity), std::max(1.0F, canvas.px(1.2F)));
        canvas.dashed_line(origin, contact, fade(colour, kBeforeOpacity), canvas.px(1.2F),
                           canvas.px(4));
    }
}

void draw_velocities(const Canvas& canvas, const Frame& frame, const Hit::Side& side, Colour colour,
                     double span_s) {
    const Vec2d from_m = side.position_m - side.velocity_before_mps * span_s;
    const ImVec2 contact = frame.at(side.position_m);
    const Vec2d half_way_m = from_m + side.velocity_before_mps * (span_s * 0.62);
    if (side.velocity_before_mps.norm() * span_s > side.radius_m * 0.25) {
        canvas.arrow(frame.at(from_m), frame.at(half_way_m), fade(palette::kText, 0.5),
                     canvas.px(2));
    }
    const ImVec2 tip = frame.at(side.position_m + side.velocity_after_mps * span_s);
    canvas.arrow(contact, tip, palette::kInk, canvas.px(5.5F));
    canvas.arrow(contact, tip, mix(colour, palette::kText, 0.55), canvas.px(3));
}

// One ball of figure 2 with its velocity split along and across the line of centres.
struct SplitSide {
    ImVec2 centre;
    float radius;
    Colour colour;
    double along_mps, across_mps;
    double px_per_mps;
};

void draw_split_side(const Canvas& canvas, const SplitSide& side, double mass_kg, double opacity) {
    draw_rubber_ball(canvas, side.centre, side.radius,
                     {mix(side.colour, palette::kPanel, 1.0 - opacity), mass_kg, false, 1.0});
    const auto along = static_cast<float>(side.along_mps * side.px_per_mps);
    const auto across = static_cast<float>(side.across_mps * side.px_per_mps);
    if (std::abs(across) > canvas.px(4)) {
        canvas.arrow(side.centre, {side.centre.x, side.centre.y - across},
                     fade(palette::kTextQuiet, 0.75), canvas.px(2));
    }
    if (std::abs(along) > canvas.px(2)) {
        const ImVec2 tip{side.centre.x + along, side.centre.y};
        canvas.arrow(side.centre, tip, palette::kInk, canvas.px(5.5F));
        canvas.arrow(side.centre, tip, palette::kText, canvas.px(3));
    } else {
        canvas.list->AddCircleFilled(side.centre, canvas.px(3), palette::kText);
    }
}

void draw_moment(const Canvas& canvas, const Box& box, const Hit& hit, const HitColours& colours,
                 bool after) {
    const Vec2d along = -hit.normal;            // from own to other: to the right
    const Vec2d across(-along.y(), along.x());  // up
    const double room = static_cast<double>(box.width());
    const double biggest_m = std::max(hit.own.radius_m, hit.other.radius_m);
    const double px_per_m =
        std::min(room * 0.085 / biggest_m, static_cast<double>(box.height()) * 0.16 / biggest_m);
    const double px_per_mps = room * 0.24 / fastest_mps(hit);
    const ImVec2 middle{box.centre().x, box.centre().y + canvas.px(4)};
    canvas.dashed_line({box.min.x + canvas.px(6), middle.y}, {box.max.x - canvas.px(6), middle.y},
                       fade(palette::kAccent, 0.5), canvas.px(1), canvas.px(4));

    const auto side_of = [&](const Hit::Side& side, Colour colour, float direction) {
        const Vec2d& velocity = after ? side.velocity_after_mps : side.velocity_before_mps;
        const auto radius = static_cast<float>(side.radius_m * px_per_m);
        return SplitSide{{middle.x + direction * radius, middle.y},
                         radius,
                         colour,
                         velocity.dot(along),
                         velocity.dot(across),
                         px_per_mps};
    };
    const SplitSide own = side_of(hit.own, colours.own, -1.0F);
    const SplitSide other = side_of(hit.other, colours.other, 1.0F);
    draw_split_side(canvas, own, hit.own.mass_kg, after ? 1.0 : 0.55);
    draw_split_side(canvas, other, hit.other.mass_kg, after ? 1.0 : 0.55);

    label(canvas, {box.centre().x, box.min.y + canvas.px(10)}, palette::kTextQuiet,
          after ? "after" : "before");
    const float foot = box.max.y - canvas.px(10);
    const auto value = [&](const SplitSide& side, Align align, float x) {
        label(canvas, {x, foot}, mix(side.colour, palette::kText, 0.4),
              signed_fixed(side.along_mps, 2) + " m/s", align);
    };
    value(own, Align::kRight, box.centre().x - canvas.px(8));
    value(other, Align::kLeft, box.centre().x + canvas.px(8));
}

}  // namespace

void draw_figure_in_plane(const Canvas& canvas, const Box& box, const Hit& hit,
                          const HitColours& colours) {
    const double touching_m = hit.own.radius_m + hit.other.radius_m;
    const double span_s = 2.1 * touching_m / fastest_mps(hit);
    const auto reach = [&](const Hit::Side& side, const Vec2d& velocity, double way) {
        return Vec2d(side.position_m + velocity * (way * span_s));
    };
    const std::array<Vec2d, 6> points = {hit.own.position_m,
                                         hit.other.position_m,
                                         reach(hit.own, hit.own.velocity_before_mps, -1),
                                         reach(hit.other, hit.other.velocity_before_mps, -1),
                                         reach(hit.own, hit.own.velocity_after_mps, 1),
                                         reach(hit.other, hit.other.velocity_after_mps, 1)};
    const double margin_m = std::max(hit.own.radius_m, hit.other.radius_m) * 1.15;
    const Frame frame = fitted(box, points, margin_m);

    draw_path(canvas, frame, hit.own, colours.own, span_s);
    draw_path(canvas, frame, hit.other, colours.other, span_s);
    for (const auto& [side, colour] :
         {std::pair{&hit.own, colours.own}, std::pair{&hit.other, colours.other}}) {
        draw_rubber_ball(canvas, frame.at(side->position_m), frame.px(side->radius_m),
                         {colour, side->mass_kg, false, 1.0});
    }
    const Vec2d along = -hit.normal;
    const Vec2d near_m = hit.own.position_m - along * (hit.own.radius_m + 0.75 * touching_m);
    const Vec2d far_m = hit.other.position_m + along * (hit.other.radius_m + 0.75 * touching_m);
    canvas.dashed_line(frame.at(near_m), frame.at(far_m), fade(palette::kAccent, 0.8),
                       canvas.px(1.3F), canvas.px(5));
    draw_velocities(canvas, frame, hit.own, colours.own, span_s);
    draw_velocities(canvas, frame, hit.other, colours.other, span_s);
}

void draw_figure_turned(const Canvas& canvas, const Box& box, const Hit& hit,
                        const HitColours& colours) {
    const float gap = canvas.px(12);
    const float half = (box.width() - gap) / 2;
    draw_moment(canvas, {box.min, {box.min.x + half, box.max.y}}, hit, colours, false);
    draw_moment(canvas, {{box.max.x - half, box.min.y}, box.max}, hit, colours, true);
}

}  // namespace fts::sdl
