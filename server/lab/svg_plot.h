// Charts as SVG text: one card with a title, two axes, and series that carry their names beside
// them, so that nobody looks up a legend. The card has its own light background and is legible on
// a dark page. Colours are those of Okabe and Ito, "Color Universal Design" (2008), which colour-
// blind readers tell apart; what is thin or written is darker than what is filled.
//
// Pure: the same plot gives the same bytes. Values that an axis cannot show (not finite, or not
// above 0 on a logarithmic one) are left out.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fts::lab {

enum class Ink { kBlue, kGreen, kOrange, kPurple, kVermillion, kSky, kGrey, kBlack };

enum class Scale { kLinear, kLog };

struct Axis {
    std::string title;
    Scale scale = Scale::kLinear;
    std::optional<double> min, max;  // else of the data, rounded outwards
};

struct PlotPoint {
    double x = 0.0, y = 0.0;
    std::string label;      // written beside the point; may be empty
    bool on_front = false;  // marked with a ring
};

enum class Marker { kNone, kCircle, kSquare, kDiamond, kTriangle };

struct Series {
    std::string label;  // beside the last point; may be empty
    std::vector<PlotPoint> points;
    Ink ink = Ink::kBlue;
    Marker marker = Marker::kCircle;
    bool hollow = false;  // a marker that is an outline only
    bool line = true;
    bool dashed = false;
};

// Drawn as steps: from each point, what is beyond it in both coordinates is worse than it.
struct Front {
    std::string label;
    std::vector<PlotPoint> points;  // ascending in x, descending in y
};

// A range of y with a word on what it means.
struct Band {
    double from = 0.0, to = 0.0;
    std::string label;
};

// A word at a place of the plot.
struct Note {
    double x = 0.0, y = 0.0;
    std::string text;
};

struct Plot {
    std::string title;
    std::string subtitle;  // wrapped as needed, as is the footnote
    std::string footnote;  // where the figures come from: the command that makes them again
    Axis x, y;
    std::vector<Series> series;
    std::optional<Front> front;
    std::vector<Band> bands;
    std::vector<Note> notes;
    double width_px = 860.0;
    double height_px = 540.0;
};

std::string render_svg(const Plot& plot);

}  // namespace fts::lab
