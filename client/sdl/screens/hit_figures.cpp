#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

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

// Words that keep out of each other's way: each takes the first of its candidate places that is
// free.
class Labels {
  public:
    Labels(const Canvas& canvas, const Box& box) : canvas_(canvas), box_(box) {}

    void avoid(const Box& box) { taken_.push_back(box); }
    void place(const std::vector<ImVec2>& candidates, Colour colour, const std::string& text) {
        const float half = canvas_.text_width(TextStyle::kCaption, text) / 2;
        const float rise = canvas_.px(8);
        Box best{};
        double best_overlap = 1e12;
        for (ImVec2 at : candidates) {
            at.x =
                std::clamp(at.x, box_.min.x + half, std::max(box_.max.x - half, box_.min.x + half));
            at.y = std::clamp(at.y, box_.min.y + rise, box_.max.y - rise);
            const Box box{{at.x - half, at.y - rise}, {at.x + half, at.y + rise}};
            double overlap = 0.0;
            for (const Box& other : taken_) overlap += shared_area(box, other);
            if (overlap < best_overlap) {
                best_overlap = overlap;
                best = box;
            }
        }
        taken_.push_back(best);
        label(canvas_, best.centre(), colour, text);
    }
    // Places around `centre`, the first one in the direction (dx, dy), right behind a radius.
    std::vector<ImVec2> around(ImVec2 centre, float radius, float dx, float dy,
                               const std::string& text) const {
        const float half = canvas_.text_width(TextStyle::kCaption, text) / 2;
        const float start = std::atan2(dy, dx);
        std::vector<ImVec2> places;
        for (const float turn : {0.0F, 0.6F, -0.6F, 1.2F, -1.2F, 1.8F, -1.8F, 2.5F, -2.5F}) {
            const float c = std::cos(start + turn), s = std::sin(start + turn);
            const float gap = radius + canvas_.px(7);
            places.push_back({centre.x + c * (gap + half), centre.y + s * (gap + canvas_.px(7))});
        }
        return places;
    }

  private:
    static double shared_area(const Box& a, const Box& b) {
        const float width = std::min(a.max.x, b.max.x) - std::max(a.min.x, b.min.x);
        const float height = std::min(a.max.y, b.max.y) - std::max(a.min.y, b.min.y);
        return width > 0 && height > 0 ? static_cast<double>(width) * static_cast<double>(height)
                                       : 0.0;
    }

    const Canvas& canvas_;
    Box box_;
    std::vector<Box> taken_;
};

// One side of figure 1 in pixels.
struct Track {
    ImVec2 origin, contact, tip;
    float radius;
    bool came, leaves;  // moved visibly before, after
};

Track track_of(const Frame& frame, const Hit::Side& side, double span_s) {
    const double visible_m = side.radius_m * 0.25;
    return {frame.at(side.position_m - side.velocity_before_mps * span_s),
            frame.at(side.position_m),
            frame.at(side.position_m + side.velocity_after_mps * span_s),
            frame.px(side.radius_m),
            side.velocity_before_mps.norm() * span_s > visible_m,
            side.velocity_after_mps.norm() * span_s > visible_m};
}

void draw_arrows(const Canvas& canvas, const Track& track) {
    if (track.came) {
        const ImVec2 way{track.contact.x - track.origin.x, track.contact.y - track.origin.y};
        canvas.arrow(track.origin, {track.origin.x + way.x * 0.62F, track.origin.y + way.y * 0.62F},
                     fade(palette::kText, 0.5), canvas.px(2));
    }
    canvas.arrow(track.contact, track.tip, palette::kText, canvas.px(3));
}

Box around_point(ImVec2 at, float reach) {
    return {{at.x - reach, at.y - reach}, {at.x + reach, at.y + reach}};
}

void reserve(const Track& track, Labels& labels) {
    labels.avoid(around_point(track.contact, track.radius * 0.9F));
    if (track.came) labels.avoid(around_point(track.origin, track.radius * 0.7F));
    for (const float part : {0.4F, 0.6F, 0.8F, 1.0F}) {
        labels.avoid(around_point({track.contact.x + (track.tip.x - track.contact.x) * part,
                                   track.contact.y + (track.tip.y - track.contact.y) * part},
                                  4.0F));
    }
}

void draw_words(const Canvas& canvas, const Track& track, const Hit::Side& side, Colour colour,
                Labels& labels) {
    const Colour ink = mix(colour, palette::kText, 0.5);
    if (track.leaves) {
        const std::string after = fixed(side.velocity_after_mps.norm(), 2) + " m/s";
        labels.place(labels.around(track.tip, 0.0F, track.tip.x - track.contact.x,
                                   track.tip.y - track.contact.y, after),
                     ink, after);
    }
    if (track.came) {
        const std::string before = fixed(side.velocity_before_mps.norm(), 2) + " m/s";
        labels.place(labels.around(track.origin, track.radius, track.origin.x - track.contact.x,
                                   track.origin.y - track.contact.y, before),
                     palette::kTextQuiet, before);
    }
    const std::string mass = mass_text(side.mass_kg);
    labels.place(labels.around(track.contact, track.radius, canvas.px(0), canvas.px(1), mass),
                 palette::kText, mass);
}

// One ball of figure 2 with its velocity split along and across the line of centres.
struct SplitSide {
    ImVec2 centre;
    float radius = 0.0F;
    Colour colour{};
    double mass_kg = 0.0;
    double along_mps = 0.0, across_mps = 0.0;
    double px_per_mps = 0.0;
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
    const Track own = track_of(frame, hit.own, span_s);
    const Track other = track_of(frame, hit.other, span_s);
    Labels labels(canvas, box);
    for (const Track& track : {own, other}) {
        draw_arrows(canvas, track);
        reserve(track, labels);
    }
    draw_words(canvas, own, hit.own, colours.own, labels);
    draw_words(canvas, other, hit.other, colours.other, labels);
}

void draw_figure_turned(const Canvas& canvas, const Box& box, const Hit& hit,
                        const HitColours& colours) {
    const float gap = canvas.px(12);
    const float half = (box.width() - gap) / 2;
    draw_moment(canvas, {box.min, {box.min.x + half, box.max.y}}, hit, colours, false);
    draw_moment(canvas, {{box.max.x - half, box.min.y}, box.max}, hit, colours, true);
}

}  // namespace fts::sdl
