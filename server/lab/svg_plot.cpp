#include "server/lab/svg_plot.h"

#include <algorithm>
#include <cmath>

#include "server/lab/svg_axis.h"
#include "server/lab/svg_labels.h"
#include "server/lab/svg_text.h"

namespace fts::lab {
namespace {

constexpr double kTitlePx = 19.0, kTextPx = 12.5, kSmallPx = 11.5;
constexpr double kEdgePx = 24.0;  // between the card's edge and what is on it
constexpr double kMarkerPx = 4.2;
constexpr double kLabelHeightPx = 16.0;
constexpr const char* kFonts =
    "system-ui, -apple-system, 'Segoe UI', Inter, Roboto, 'Helvetica Neue', Arial, sans-serif";

struct Colours {
    const char* fill;
    const char* text;  // dark enough to be read
};

Colours colours_of(Ink ink) {
    switch (ink) {
        case Ink::kBlue:
            return {"#0072b2", "#005a8e"};
        case Ink::kGreen:
            return {"#009e73", "#00694d"};
        case Ink::kOrange:
            return {"#e69f00", "#8a5a00"};
        case Ink::kPurple:
            return {"#cc79a7", "#96416f"};
        case Ink::kVermillion:
            return {"#d55e00", "#a84a00"};
        case Ink::kSky:
            return {"#56b4e9", "#1f6f9f"};
        case Ink::kGrey:
            return {"#8c8c8c", "#666666"};
        case Ink::kBlack:
            break;
    }
    return {"#1f1f1f", "#1f1f1f"};
}

std::string attribute(const char* name, double value) {
    return std::string(" ") + name + "=\"" + pixels(value) + "\"";
}

// Text of the chart; `place` is "start", "middle" or "end".
std::string text_at(double x, double y, const char* place, double size, const char* colour,
                    const std::string& text, const char* more = "") {
    return "<text" + attribute("x", x) + attribute("y", y) + " text-anchor=\"" + place + "\"" +
           attribute("font-size", size) + " fill=\"" + colour + "\"" + more + ">" +
           xml_escaped(text) + "</text>\n";
}

class Drawing {
  public:
    explicit Drawing(const Plot& plot)
        : plot_(plot), x_(plot.x, values_of(&PlotPoint::x)), y_(plot.y, values_of(&PlotPoint::y)) {}

    std::string run() {
        lay_out();
        draw_bands();
        draw_grid();
        draw_axes();
        draw_front();
        for (const Series& series : plot_.series) draw_line(series);
        for (const Series& series : plot_.series) draw_markers(series);
        label_lines();
        label_points();
        return header() + body_ + "</g>\n</svg>\n";
    }

  private:
    std::vector<double> values_of(double PlotPoint::*coordinate) const;
    void lay_out();
    double room_for_line_labels() const;
    std::string header() const;
    void draw_bands();
    void draw_grid();
    void draw_axes();
    void draw_tick_label(const Tick& tick, bool is_x);
    void draw_front();
    void draw_line(const Series& series);
    void draw_markers(const Series& series);
    void draw_marker(const Series& series, double x, double y);
    void label_lines();
    void label_points();
    void draw_label(const PlacedLabel& label, const LabelWish& wish, const std::string& text,
                    Ink ink, bool bold);

    bool shows(const PlotPoint& point) const { return x_.shows(point.x) && y_.shows(point.y); }
    const PlotPoint* last_shown(const Series& series) const {
        const auto found = std::find_if(series.points.rbegin(), series.points.rend(),
                                        [&](const PlotPoint& point) { return shows(point); });
        return found == series.points.rend() ? nullptr : &*found;
    }
    void line(double x1, double y1, double x2, double y2, const char* colour, double width,
              const char* more = "") {
        body_ += "<line" + attribute("x1", x1) + attribute("y1", y1) + attribute("x2", x2) +
                 attribute("y2", y2) + " stroke=\"" + colour + "\"" +
                 attribute("stroke-width", width) + more + "/>\n";
    }

    const Plot& plot_;
    AxisScale x_, y_;
    PixelBox area_;  // of the data
    std::vector<std::string> subtitle_, footnote_;
    std::vector<PixelBox> obstacles_;
    std::vector<PixelSegment> lines_;
    std::string body_;
};

std::vector<double> Drawing::values_of(double PlotPoint::*coordinate) const {
    std::vector<double> values;
    for (const Series& series : plot_.series) {
        for (const PlotPoint& point : series.points) values.push_back(point.*coordinate);
    }
    return values;
}

double Drawing::room_for_line_labels() const {
    double room = 0.0;
    for (const Series& series : plot_.series) {
        if (!series.line || series.label.empty()) continue;
        room = std::max(room, text_width_px(series.label, kTextPx) + 22.0);
    }
    return room;
}

void Drawing::lay_out() {
    const double text_width = plot_.width_px - 2 * kEdgePx;
    subtitle_ = wrapped_lines(plot_.subtitle, kTextPx, text_width);
    footnote_ = wrapped_lines(plot_.footnote, kSmallPx, text_width);
    area_.left = kEdgePx + 46.0;
    area_.right = plot_.width_px - kEdgePx - room_for_line_labels();
    area_.top = 44.0 + 17.0 * static_cast<double>(subtitle_.size()) + 36.0;
    area_.bottom = plot_.height_px - 54.0 -
                   16.0 * static_cast<double>(std::max<std::size_t>(1, footnote_.size()));
    x_.span_pixels(area_.left, area_.right);
    y_.span_pixels(area_.bottom, area_.top);
}

std::string Drawing::header() const {
    const std::string size = pixels(plot_.width_px) + " " + pixels(plot_.height_px);
    std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size + "\"" +
                      attribute("width", plot_.width_px) + attribute("height", plot_.height_px) +
                      " role=\"img\">\n<title>" + xml_escaped(plot_.title) + "</title>\n<desc>" +
                      xml_escaped(plot_.subtitle) + "</desc>\n";
    out += "<rect x=\"0.5\" y=\"0.5\"" + attribute("width", plot_.width_px - 1) +
           attribute("height", plot_.height_px - 1) +
           " rx=\"10\" fill=\"#fdfcfa\" stroke=\"#dedad2\"/>\n";
    out += std::string("<g font-family=\"") + kFonts + "\">\n";
    out += text_at(kEdgePx, 36.0, "start", kTitlePx, "#1f1f1f", plot_.title,
                   " font-weight=\"650\" letter-spacing=\"-0.2\"");
    double y = 57.0;
    for (const std::string& text : subtitle_) {
        out += text_at(kEdgePx, y, "start", kTextPx, "#5a5752", text);
        y += 17.0;
    }
    y = plot_.height_px - 16.0 * static_cast<double>(footnote_.size()) + 2.0;
    for (const std::string& text : footnote_) {
        out += text_at(kEdgePx, y, "start", kSmallPx, "#85817a", text);
        y += 16.0;
    }
    return out;
}

void Drawing::draw_bands() {
    for (const Band& band : plot_.bands) {
        const double low = std::clamp(band.from, y_.min(), y_.max());
        const double high = std::clamp(band.to, y_.min(), y_.max());
        const double top = y_.pixel_of(high), bottom = y_.pixel_of(low);
        if (bottom - top < 0.5) continue;
        body_ += "<rect" + attribute("x", area_.left) + attribute("y", top) +
                 attribute("width", area_.right - area_.left) + attribute("height", bottom - top) +
                 " fill=\"#efece4\"/>\n";
        const double left = area_.left + 8.0;
        body_ += text_at(left, top + 16.0, "start", kSmallPx, "#85817a", band.label);
        const double width = text_width_px(band.label, kSmallPx);
        obstacles_.push_back({left, top + 4.0, left + width, top + 20.0});
    }
}

void Drawing::draw_grid() {
    for (const Tick& tick : x_.ticks()) {
        const double x = x_.pixel_of(tick.value);
        line(x, area_.top, x, area_.bottom, tick.major() ? "#e4e1da" : "#f3f1ec", 1.0);
    }
    for (const Tick& tick : y_.ticks()) {
        const double y = y_.pixel_of(tick.value);
        line(area_.left, y, area_.right, y, tick.major() ? "#e4e1da" : "#f3f1ec", 1.0);
    }
}

void Drawing::draw_axes() {
    line(area_.left, area_.bottom, area_.right, area_.bottom, "#8f8b84", 1.2);
    for (const Tick& tick : x_.ticks()) {
        const double x = x_.pixel_of(tick.value);
        if (tick.major()) {
            line(x, area_.bottom, x, area_.bottom + 5.0, "#8f8b84", 1.2);
            draw_tick_label(tick, true);
        }
    }
    for (const Tick& tick : y_.ticks()) {
        if (tick.major()) draw_tick_label(tick, false);
    }
    body_ += text_at((area_.left + area_.right) / 2, area_.bottom + 41.0, "middle", kTextPx,
                     "#3d3a36", plot_.x.title, " font-weight=\"550\"");
    body_ += text_at(kEdgePx, area_.top - 16.0, "start", kTextPx, "#3d3a36", plot_.y.title,
                     " font-weight=\"550\"");
}

void Drawing::draw_tick_label(const Tick& tick, bool is_x) {
    const double x = is_x ? x_.pixel_of(tick.value) : area_.left - 9.0;
    const double y = is_x ? area_.bottom + 20.0 : y_.pixel_of(tick.value) + 4.2;
    const char* place = is_x ? "middle" : "end";
    if (!tick.power_of_10) {
        body_ += text_at(x, y, place, kTextPx, "#5a5752", tick.label);
        return;
    }
    std::string power = std::to_string(std::abs(*tick.power_of_10));
    if (*tick.power_of_10 < 0) power.insert(0, "\u2212");
    body_ += "<text" + attribute("x", x) + attribute("y", y + 1.0) + " text-anchor=\"" + place +
             "\"" + attribute("font-size", kTextPx) + " fill=\"#5a5752\">10<tspan dy=\"-5\"" +
             attribute("font-size", 9.5) + ">" + power + "</tspan></text>\n";
}

void Drawing::draw_front() {
    if (!plot_.front) return;
    std::string path;
    double x = 0.0, y = 0.0;
    for (const PlotPoint& point : plot_.front->points) {
        if (!shows(point)) continue;
        const double next_x = x_.pixel_of(point.x), next_y = y_.pixel_of(point.y);
        if (path.empty()) {
            path = "M" + pixels(next_x) + " " + pixels(area_.top) + "V" + pixels(next_y);
            lines_.push_back({next_x, area_.top, next_x, next_y});
        } else {
            path += "H" + pixels(next_x) + "V" + pixels(next_y);
            lines_.push_back({x, y, next_x, y});
            lines_.push_back({next_x, y, next_x, next_y});
        }
        x = next_x;
        y = next_y;
    }
    if (path.empty()) return;
    path += "H" + pixels(area_.right);
    lines_.push_back({x, y, area_.right, y});
    body_ += "<path d=\"" + path + "V" + pixels(area_.top) +
             "Z\" fill=\"#0072b2\" fill-opacity=\"0.045\"/>\n";
    body_ += "<path d=\"" + path +
             "\" fill=\"none\" stroke=\"#9fb6c4\" stroke-width=\"2\" stroke-linejoin=\"round\"/>\n";
    const double width = text_width_px(plot_.front->label, kSmallPx);
    body_ += text_at(area_.right - 6.0, y - 7.0, "end", kSmallPx, "#5f7a8a", plot_.front->label);
    obstacles_.push_back({area_.right - 6.0 - width, y - 20.0, area_.right - 6.0, y - 2.0});
}

void Drawing::draw_line(const Series& series) {
    if (!series.line) return;
    std::string path;
    const PlotPoint* before = nullptr;
    for (const PlotPoint& point : series.points) {
        if (!shows(point)) {
            before = nullptr;
            continue;
        }
        const double x = x_.pixel_of(point.x), y = y_.pixel_of(point.y);
        path += (before ? "L" : "M") + pixels(x) + " " + pixels(y);
        if (before) lines_.push_back({x_.pixel_of(before->x), y_.pixel_of(before->y), x, y});
        before = &point;
    }
    if (path.empty()) return;
    body_ += "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + colours_of(series.ink).fill +
             "\" stroke-width=\"2\" stroke-linejoin=\"round\" stroke-linecap=\"round\"" +
             (series.dashed ? " stroke-dasharray=\"5 4\"" : "") + "/>\n";
}

void Drawing::draw_markers(const Series& series) {
    for (const PlotPoint& point : series.points) {
        if (!shows(point)) continue;
        const double x = x_.pixel_of(point.x), y = y_.pixel_of(point.y);
        if (point.on_front) {
            body_ += "<circle" + attribute("cx", x) + attribute("cy", y) +
                     " r=\"8.5\" fill=\"none\" stroke=\"#5f7a8a\" stroke-width=\"1.6\"/>\n";
        }
        if (series.marker != Marker::kNone) draw_marker(series, x, y);
        const double reach = point.on_front ? 9.0 : kMarkerPx + 1.0;
        if (!series.line || point.on_front) {
            obstacles_.push_back({x - reach, y - reach, x + reach, y + reach});
        }
    }
}

void Drawing::draw_marker(const Series& series, double x, double y) {
    const Colours colours = colours_of(series.ink);
    const std::string paint = std::string(" fill=\"") + (series.hollow ? "#fdfcfa" : colours.fill) +
                              "\" stroke=\"" + (series.hollow ? colours.fill : "#fdfcfa") +
                              "\" stroke-width=\"" + (series.hollow ? "1.8" : "1") + "\"/>\n";
    const double r = kMarkerPx;
    const auto polygon = [&](std::initializer_list<std::pair<double, double>> corners) {
        std::string points;
        for (const auto& [dx, dy] : corners) {
            points += (points.empty() ? "" : " ") + pixels(x + dx) + "," + pixels(y + dy);
        }
        body_ += "<polygon points=\"" + points + "\"" + paint;
    };
    switch (series.marker) {
        case Marker::kSquare:
            polygon({{-r * 0.9, -r * 0.9},
                     {r * 0.9, -r * 0.9},
                     {r * 0.9, r * 0.9},
                     {-r * 0.9, r * 0.9}});
            break;
        case Marker::kDiamond:
            polygon({{0, -r * 1.3}, {r * 1.3, 0}, {0, r * 1.3}, {-r * 1.3, 0}});
            break;
        case Marker::kTriangle:
            polygon({{0, -r * 1.25}, {r * 1.15, r * 0.85}, {-r * 1.15, r * 0.85}});
            break;
        case Marker::kCircle:
        case Marker::kNone:
            body_ +=
                "<circle" + attribute("cx", x) + attribute("cy", y) + attribute("r", r) + paint;
    }
}

void Drawing::draw_label(const PlacedLabel& label, const LabelWish& wish, const std::string& text,
                         Ink ink, bool bold) {
    if (label.far) {
        const double x = std::clamp(wish.x, label.box.left, label.box.right);
        const double y = std::clamp(wish.y, label.box.top + 3.0, label.box.bottom - 3.0);
        line(wish.x, wish.y, x, y, "#b9b4ab", 0.8);
    }
    body_ += text_at(label.box.left, label.box.bottom - 4.0, "start", kTextPx, colours_of(ink).text,
                     text,
                     bold ? " font-weight=\"600\" stroke=\"#fdfcfa\" stroke-width=\"3\" "
                            "stroke-linejoin=\"round\" paint-order=\"stroke\""
                          : " stroke=\"#fdfcfa\" stroke-width=\"3\" stroke-linejoin=\"round\" "
                            "paint-order=\"stroke\"");
}

// In a column right of the data, as high as each line ends.
void Drawing::label_lines() {
    std::vector<const Series*> labelled;
    std::vector<double> wishes;
    for (const Series& series : plot_.series) {
        const PlotPoint* last = last_shown(series);
        if (!series.line || series.label.empty() || !last) continue;
        labelled.push_back(&series);
        wishes.push_back(y_.pixel_of(last->y));
    }
    const auto heights = spread_out(wishes, kLabelHeightPx, area_.top, area_.bottom - 8.0);
    for (std::size_t i = 0; i < labelled.size(); ++i) {
        const Series& series = *labelled[i];
        const double x = x_.pixel_of(last_shown(series)->x);
        const double label_x = area_.right + 20.0;
        if (std::abs(heights[i] - wishes[i]) > 3.0 || x < area_.right - 30.0) {
            line(x + kMarkerPx + 2.0, wishes[i], label_x - 3.0, heights[i], "#cfcac0", 0.8);
        }
        body_ += text_at(label_x, heights[i] + 4.2, "start", kTextPx, colours_of(series.ink).text,
                         series.label, " font-weight=\"550\"");
    }
}

void Drawing::label_points() {
    struct Named {
        const std::string* text;
        Ink ink;
        bool bold;
    };
    std::vector<LabelWish> wishes;
    std::vector<Named> names;
    const auto wish_for = [&](const PlotPoint& point, const std::string& text, Ink ink) {
        if (text.empty() || !shows(point)) return;
        wishes.push_back({x_.pixel_of(point.x), y_.pixel_of(point.y), text_width_px(text, kTextPx),
                          kLabelHeightPx});
        names.push_back({&text, ink, point.on_front});
    };
    for (const Series& series : plot_.series) {
        for (const PlotPoint& point : series.points) wish_for(point, point.label, series.ink);
    }
    for (const Note& note : plot_.notes) {
        wish_for({note.x, note.y, "", false}, note.text, Ink::kGrey);
    }
    const PixelBox room{area_.left + 3.0, area_.top + 2.0, plot_.width_px - kEdgePx / 2,
                        area_.bottom - 3.0};
    const auto placed = place_labels(wishes, room, obstacles_, lines_);
    for (std::size_t i = 0; i < placed.size(); ++i) {
        draw_label(placed[i], wishes[i], *names[i].text, names[i].ink, names[i].bold);
    }
}

}  // namespace

std::string render_svg(const Plot& plot) {
    return Drawing(plot).run();
}

}  // namespace fts::lab
