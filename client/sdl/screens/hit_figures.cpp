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

// Beyond `tip`, on the way from `tail`, but inside the box.
void label_beyond(const Canvas& canvas, const Box& box, ImVec2 tail, ImVec2 tip, float gap,
                  Colour colour, const std::string& text) {
    const float dx = tip.x - tail.x, dy = tip.y - tail.y;
    const float length = std::max(std::hypot(dx, dy), 1.0F);
    const float half = canvas.text_width(TextStyle::kCaption, text) / 2;
    ImVec2 at{tip.x + dx / length * (gap + half * std::abs(dx) / length),
              tip.y + dy / length * gap};
    at.x = std::clamp(at.x, box.min.x + half, std::max(box.max.x - half, box.min.x + half));
    at.y = std::clamp(at.y, box.min.y + canvas.px(7), box.max.y - canvas.px(7));
    label(canvas, at, colour, text);
}

void draw_velocities(const Canvas& canvas, const Frame& frame, const Box& box,
                     const Hit::Side& side, Colour colour, double span_s) {
    const double before_mps = side.velocity_before_mps.norm();
    const double after_mps = side.velocity_after_mps.norm();
    const ImVec2 contact = frame.at(side.position_m);
    const Vec2d from_m = side.position_m - side.velocity_before_mps * span_s;
    if (before_mps * span_s > side.radius_m * 0.25) {
        const Vec2d half_way_m = from_m + side.velocity_before_mps * (span_s * 0.62);
        const ImVec2 tail = frame.at(from_m);
        canvas.arrow(tail, frame.at(half_way_m), fade(palette::kText, 0.5), canvas.px(2));
        label_beyond(canvas, box, contact, tail, frame.px(side.radius_m) + canvas.px(12),
                     palette::kTextQuiet, fixed(before_mps, 2) + " m/s");
    }
    const ImVec2 tip = frame.at(side.position_m + side.velocity_after_mps * span_s);
    canvas.arrow(contact, tip, palette::kText, canvas.px(3));
    if (after_mps * span_s > side.radius_m * 0.25) {
        label_beyond(canvas, box, contact, tip, canvas.px(12), mix(colour, palette::kText, 0.5),
                     fixed(after_mps, 2) + " m/s");
    }
}

// Beside the ball, across the line of centres, on the side that it does not leave by.
void draw_mass(const Canvas& canvas, const Frame& frame, const Hit::Side& side,
               const Vec2d& along) {
    Vec2d across(-along.y(), along.x());
    const Vec2d travel = side.velocity_after_mps - side.velocity_before_mps * 0.5;
    if (across.dot(travel) > 0.0) across = -across;
    const ImVec2 centre = frame.at(side.position_m);
    const std::string text = mass_text(side.mass_kg);
    const float half = canvas.text_width(TextStyle::kCaption, text) / 2;
    const auto x = static_cast<float>(across.x()), y = static_cast<float>(across.y());
    const float gap = frame.px(side.radius_m) + canvas.px(9);
    label(canvas, {centre.x + x * (gap + half * std::abs(x)), centre.y - y * (gap + canvas.px(5))},
          palette::kText, text);
}

// One ball of figure 2 with its velocity split along and across the line of centres.
struct SplitSide {
    ImVec2 centre;
    float radius;
    Colour colour;
    double mass_kg;
    double along_mps, across_mps;
    double px_per_mps;
};

void draw_split_side(const Canvas& canvas, const SplitSide& side, float arrow_y, float sign) {
    draw_rubber_ball(canvas, side.centre, side.radius, {side.colour, side.mass_kg, false, 1.0});
    const auto across = static_cast<float>(side.across_mps * side.px_per_mps);
    if (std::abs(across) > canvas.px(3)) {
        canvas.arrow(side.centre, {side.centre.x, side.centre.y - across},
                     fade(palette::kInk, 0.75), canvas.px(2));
    }
    const auto along = static_cast<float>(side.along_mps * side.px_per_mps);
    const ImVec2 start{side.centre.x, arrow_y};
    canvas.arrow(start, {start.x + along, start.y}, mix(side.colour, palette::kText, 0.5),
                 canvas.px(3));
    canvas.dashed_line({start.x, arrow_y}, {start.x, side.centre.y - side.radius},
                       fade(palette::kTextFaint, 0.6), canvas.px(1), canvas.px(2));
    label(canvas, {side.centre.x + sign * side.radius * 0.2F, arrow_y - canvas.px(15)},
          mix(side.colour, palette::kText, 0.5), signed_fixed(side.along_mps, 2),
          sign < 0 ? Align::kRight : Align::kLeft);
}

void draw_moment(const Canvas& canvas, const Box& box, const Hit& hit, const HitColours& colours,
                 bool after) {
    const Vec2d along = -hit.normal;            // from own to other: to the right
    const Vec2d across(-along.y(), along.x());  // up
    const double biggest_m = std::max(hit.own.radius_m, hit.other.radius_m);
    const double px_per_m = std::min(static_cast<double>(box.width()) * 0.15 / biggest_m,
                                     static_cast<double>(box.height()) * 0.22 / biggest_m);
    const double px_per_mps = static_cast<double>(box.width()) * 0.30 / fastest_mps(hit);
    const auto largest = static_cast<float>(biggest_m * px_per_m);
    const ImVec2 middle{box.centre().x, box.max.y - largest - canvas.px(10)};
    canvas.dashed_line({box.min.x + canvas.px(6), middle.y}, {box.max.x - canvas.px(6), middle.y},
                       fade(palette::kAccent, 0.6), canvas.px(1.2F), canvas.px(4));
    const auto side_of = [&](const Hit::Side& side, Colour colour, float direction) {
        const Vec2d& velocity = after ? side.velocity_after_mps : side.velocity_before_mps;
        const auto radius = static_cast<float>(side.radius_m * px_per_m);
        return SplitSide{{middle.x + direction * radius, middle.y},
                         radius,
                         colour,
                         side.mass_kg,
                         velocity.dot(along),
                         velocity.dot(across),
                         px_per_mps};
    };
    const float arrow_y = middle.y - largest - canvas.px(12);
    draw_split_side(canvas, side_of(hit.own, colours.own, -1.0F), arrow_y, -1.0F);
    draw_split_side(canvas, side_of(hit.other, colours.other, 1.0F), arrow_y, 1.0F);
    label(canvas, {box.centre().x, box.min.y + canvas.px(6)}, palette::kTextQuiet,
          after ? "after, m/s" : "before, m/s");
}

}  // namespace

void draw_figure_in_plane(const Canvas& canvas, const Box& box, const Hit& hit,
                          const HitColours& colours) {
    const double touching_m = hit.own.radius_m + hit.other.radius_m;
    const double span_s = 1.7 * touching_m / fastest_mps(hit);
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
    // Room for the words beside the outermost balls.
    const float words = canvas.px(44);
    const Frame frame =
        fitted({{box.min.x + words, box.min.y}, {box.max.x - words, box.max.y}}, points, margin_m);

    draw_path(canvas, frame, hit.own, colours.own, span_s);
    draw_path(canvas, frame, hit.other, colours.other, span_s);
    for (const auto& [side, colour] :
         {std::pair{&hit.own, colours.own}, std::pair{&hit.other, colours.other}}) {
        draw_rubber_ball(canvas, frame.at(side->position_m), frame.px(side->radius_m),
                         {colour, side->mass_kg, false, 1.0});
    }
    const Vec2d along = -hit.normal;
    const Vec2d near_m = hit.own.position_m - along * (hit.own.radius_m + 0.45 * touching_m);
    const Vec2d far_m = hit.other.position_m + along * (hit.other.radius_m + 0.45 * touching_m);
    canvas.dashed_line(frame.at(near_m), frame.at(far_m), fade(palette::kAccent, 0.8),
                       canvas.px(1.3F), canvas.px(5));
    draw_mass(canvas, frame, hit.own, along);
    draw_mass(canvas, frame, hit.other, along);
    draw_velocities(canvas, frame, box, hit.own, colours.own, span_s);
    draw_velocities(canvas, frame, box, hit.other, colours.other, span_s);
}

void draw_figure_turned(const Canvas& canvas, const Box& box, const Hit& hit,
                        const HitColours& colours) {
    const float gap = canvas.px(12);
    const float half = (box.width() - gap) / 2;
    draw_moment(canvas, {box.min, {box.min.x + half, box.max.y}}, hit, colours, false);
    draw_moment(canvas, {{box.max.x - half, box.min.y}, box.max}, hit, colours, true);
}

}  // namespace fts::sdl
