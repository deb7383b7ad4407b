#include "client/sdl/canvas.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fts::sdl {
namespace {

constexpr float kTau = 2.0F * std::numbers::pi_v<float>;

ImVec2 on_circle(ImVec2 centre, float radius, int step, int steps) {
    const float angle = kTau * static_cast<float>(step) / static_cast<float>(steps);
    return {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
}

void vertex(ImDrawList& list, ImVec2 at, Colour colour) {
    list.PrimWriteVtx(at, ImGui::GetFontTexUvWhitePixel(), colour);
}

void index(ImDrawList& list, unsigned value) {
    list.PrimWriteIdx(static_cast<ImDrawIdx>(value));
}

// The length of the longest prefix that is whole UTF-8 characters and at most `bytes` long.
std::size_t whole_characters(std::string_view text, std::size_t bytes) {
    if (bytes >= text.size()) return text.size();
    while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xc0U) == 0x80U) --bytes;
    return bytes;
}

}  // namespace

int segments_for(float radius_px) {
    return std::clamp(static_cast<int>(std::sqrt(std::max(radius_px, 1.0F)) * 7.0F), 16, 200);
}

std::string single_line(std::string_view text) {
    std::string line(text);
    std::replace_if(
        line.begin(), line.end(),
        [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == '\x7f'; }, ' ');
    return line;
}

Box Canvas::centred(float width_units, float height_units) const {
    const float half_width = px(width_units) / 2, half_height = px(height_units) / 2;
    return {{size.x / 2 - half_width, size.y / 2 - half_height},
            {size.x / 2 + half_width, size.y / 2 + half_height}};
}

float Canvas::text_width(TextStyle style, std::string_view text) const {
    const std::string line = single_line(text);
    const char* begin = line.data();
    return type.font(style)
        ->CalcTextSizeA(type.size_px(style), 1e6F, 0.0F, begin, begin + line.size())
        .x;
}

void Canvas::text(ImVec2 at, TextStyle style, Colour colour, std::string_view text,
                  Align align) const {
    const std::string line = single_line(text);
    if (align != Align::kLeft) {
        at.x -= text_width(style, line) * (align == Align::kCentre ? 0.5F : 1.0F);
    }
    at = {std::round(at.x), std::round(at.y)};
    list->AddText(type.font(style), type.size_px(style), at, colour, line.data(),
                  line.data() + line.size());
}

void Canvas::text_middle(ImVec2 at, TextStyle style, Colour colour, std::string_view text,
                         Align align, float size_px) const {
    const std::string line = single_line(text);
    if (size_px <= 0.0F) size_px = type.size_px(style);
    const float width = text_width(style, line) * size_px / type.size_px(style);
    if (align != Align::kLeft) at.x -= width * (align == Align::kCentre ? 0.5F : 1.0F);
    at = {std::round(at.x), std::round(at.y - size_px * 0.5F)};
    list->AddText(type.font(style), size_px, at, colour, line.data(), line.data() + line.size());
}

float Canvas::paragraph(ImVec2 at, float width, TextStyle style, Colour colour,
                        std::string_view text, Align align) const {
    std::string rest = single_line(text);
    const float top = at.y;
    const ImFont& font = *type.font(style);
    while (!rest.empty()) {
        const char* begin = rest.data();
        const char* end = begin + rest.size();
        const char* cut =
            font.CalcWordWrapPositionA(type.size_px(style) / font.FontSize, begin, end, width);
        if (cut == begin) cut = begin + std::max<std::size_t>(whole_characters(rest, 4), 1);
        const auto length = static_cast<std::size_t>(cut - begin);
        this->text(at, style, colour, std::string_view(rest).substr(0, length), align);
        at.y += line_height(style);
        rest.erase(0, length);
        rest.erase(0, rest.find_first_not_of(' '));
    }
    return at.y - top;
}

std::string Canvas::elided(TextStyle style, std::string_view text, float width) const {
    std::string line = single_line(text);
    if (text_width(style, line) <= width) return line;
    const std::string ellipsis = "\xe2\x80\xa6";
    while (!line.empty() && text_width(style, line + ellipsis) > width) {
        line.resize(whole_characters(line, line.size() - 1));
    }
    return line + ellipsis;
}

void Canvas::panel(const Box& box, Colour fill, Colour line) const {
    const float corner = px(space::kCorner);
    list->AddRectFilled(box.min, box.max, fill, corner);
    list->AddRect(box.min, box.max, line, corner, 0, std::max(1.0F, px(1)));
}

void Canvas::line(ImVec2 a, ImVec2 b, Colour colour, float thickness) const {
    list->AddLine(a, b, colour, thickness);
}

void Canvas::dashed_line(ImVec2 a, ImVec2 b, Colour colour, float thickness, float dash) const {
    const float dx = b.x - a.x, dy = b.y - a.y;
    const float length = std::hypot(dx, dy);
    if (length < 1.0F || dash < 1.0F) return;
    for (float at = 0.0F; at < length; at += 2.0F * dash) {
        const float from = at / length, to = std::min(at + dash, length) / length;
        list->AddLine({a.x + dx * from, a.y + dy * from}, {a.x + dx * to, a.y + dy * to}, colour,
                      thickness);
    }
}

void Canvas::arrow(ImVec2 tail, ImVec2 tip, Colour colour, float thickness) const {
    const float dx = tip.x - tail.x, dy = tip.y - tail.y;
    const float length = std::hypot(dx, dy);
    const float head = thickness * 4.0F;
    if (length < head * 0.6F) {
        list->AddCircleFilled(tip, thickness, colour);
        return;
    }
    const float ux = dx / length, uy = dy / length;
    const float depth = std::min(head, length * 0.6F);
    const ImVec2 neck{tip.x - ux * depth, tip.y - uy * depth};
    const float wing = depth * 0.5F;
    list->AddLine(tail, {neck.x + ux, neck.y + uy}, colour, thickness);
    list->AddTriangleFilled(tip, {neck.x - uy * wing, neck.y + ux * wing},
                            {neck.x + uy * wing, neck.y - ux * wing}, colour);
}

void Canvas::ring(ImVec2 centre, float radius, Colour colour, float thickness) const {
    if (radius <= 0.0F) return;
    list->AddCircle(centre, radius, colour, segments_for(radius), thickness);
}

void Canvas::gradient_ring(ImVec2 centre, float r0, Colour inner, float r1, Colour outer) const {
    const int steps = segments_for(std::max(r0, r1));
    list->PrimReserve(steps * 6, (steps + 1) * 2);
    const unsigned base = list->_VtxCurrentIdx;
    for (int i = 0; i <= steps; ++i) {
        vertex(*list, on_circle(centre, r0, i, steps), inner);
        vertex(*list, on_circle(centre, r1, i, steps), outer);
    }
    for (unsigned i = 0; i < static_cast<unsigned>(steps); ++i) {
        const unsigned first = base + 2 * i;
        for (const unsigned corner : {0U, 1U, 3U, 0U, 3U, 2U}) index(*list, first + corner);
    }
}

void Canvas::gradient_disc(ImVec2 centre, float radius, ImVec2 focus, Colour middle,
                           Colour rim) const {
    const int steps = segments_for(radius);
    list->PrimReserve(steps * 3, steps + 1);
    const unsigned base = list->_VtxCurrentIdx;
    vertex(*list, focus, middle);
    for (int i = 0; i < steps; ++i) vertex(*list, on_circle(centre, radius, i, steps), rim);
    const auto count = static_cast<unsigned>(steps);
    for (unsigned i = 0; i < count; ++i) {
        index(*list, base);
        index(*list, base + 1 + i);
        index(*list, base + 1 + (i + 1) % count);
    }
}

void Canvas::gradient_box(const Box& box, Colour top, Colour bottom) const {
    list->AddRectFilledMultiColor(box.min, box.max, top, top, bottom, bottom);
}

void Canvas::coin(ImVec2 centre, float radius) const {
    list->AddCircleFilled({centre.x, centre.y + radius * 0.16F}, radius, palette::kGoldDeep,
                          segments_for(radius));
    list->AddCircleFilled(centre, radius, palette::kGold, segments_for(radius));
    ring(centre, radius * 0.64F, palette::kGoldDeep, std::max(1.0F, radius * 0.14F));
}

}  // namespace fts::sdl
