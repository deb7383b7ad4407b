// Canvas: where one frame is drawn. A draw list with the window's size, its type scale and the
// drawing vocabulary that all screens share. A plain value, valid for one frame.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <imgui.h>

#include "client/sdl/fonts.h"
#include "client/sdl/theme.h"

namespace fts::sdl {

enum class Align : std::uint8_t { kLeft, kCentre, kRight };

struct Box {
    ImVec2 min, max;
    float width() const { return max.x - min.x; }
    float height() const { return max.y - min.y; }
    ImVec2 centre() const { return {(min.x + max.x) / 2, (min.y + max.y) / 2}; }
    bool holds(ImVec2 point) const {
        return point.x >= min.x && point.x < max.x && point.y >= min.y && point.y < max.y;
    }
};

struct Canvas {
    ImDrawList* list = nullptr;
    ImVec2 size;  // of the window, pixels
    TypeScale type;
    double time_s = 0.0;  // of any monotonic clock; drives what moves by itself

    float px(float units) const { return units * type.unit; }
    Box whole() const { return {{0, 0}, size}; }
    Box centred(float width_units, float height_units) const;

    // `at` is the top of the line: its left end, middle or right end. Text is one line: line breaks
    // and other control characters in it are drawn as spaces.
    void text(ImVec2 at, TextStyle style, Colour colour, std::string_view text,
              Align align = Align::kLeft) const;
    // The same with the line's middle at at.y, and any size.
    void text_middle(ImVec2 at, TextStyle style, Colour colour, std::string_view text, Align align,
                     float size_px = 0.0F) const;
    float text_width(TextStyle style, std::string_view text) const;
    float line_height(TextStyle style) const { return type.size_px(style) * 1.25F; }
    // Breaks lines at spaces. Returns the height taken.
    float paragraph(ImVec2 at, float width, TextStyle style, Colour colour, std::string_view text,
                    Align align = Align::kLeft) const;
    // `text` cut so that it is no wider than `width`, with an ellipsis where it was cut.
    std::string elided(TextStyle style, std::string_view text, float width) const;

    void panel(const Box& box, Colour fill = palette::kPanel, Colour line = palette::kLine) const;
    void line(ImVec2 a, ImVec2 b, Colour colour, float thickness) const;
    void dashed_line(ImVec2 a, ImVec2 b, Colour colour, float thickness, float dash) const;
    // From `tail` to `tip`; one shorter than its head is drawn as a dot.
    void arrow(ImVec2 tail, ImVec2 tip, Colour colour, float thickness) const;
    void ring(ImVec2 centre, float radius, Colour colour, float thickness) const;
    // Shaded from `inner` at r0 to `outer` at r1. Edges are not anti-aliased: cover them or end
    // clear.
    void gradient_ring(ImVec2 centre, float r0, Colour inner, float r1, Colour outer) const;
    // Shaded from `focus`, inside the disc, to its rim.
    void gradient_disc(ImVec2 centre, float radius, ImVec2 focus, Colour middle, Colour rim) const;
    void gradient_box(const Box& box, Colour top, Colour bottom) const;
    void coin(ImVec2 centre, float radius) const;
};

// How many straight pieces draw a circle of this radius without visible corners.
int segments_for(float radius_px);

// A copy without control characters, for text that came from outside.
std::string single_line(std::string_view text);

}  // namespace fts::sdl
