#include "client/sdl/rasteriser.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace fts::sdl {
namespace {

// ImGui packs ABGR, the target is ARGB.
std::uint32_t argb(Colour colour) {
    return (colour & 0xff00ff00U) | ((colour & 0xffU) << 16U) | ((colour >> 16U) & 0xffU);
}

// `alpha` in [0, 255]. Both red and blue in one multiplication.
std::uint32_t blend(std::uint32_t under, std::uint32_t over, std::uint32_t alpha) {
    const std::uint32_t share = alpha + (alpha >> 7U);  // [0, 256]
    const std::uint32_t rest = 256U - share;
    const std::uint32_t red_blue =
        ((over & 0xff00ffU) * share + (under & 0xff00ffU) * rest + 0x800080U) >> 8U;
    const std::uint32_t green =
        ((over & 0x00ff00U) * share + (under & 0x00ff00U) * rest + 0x008000U) >> 8U;
    return 0xff000000U | (red_blue & 0xff00ffU) | (green & 0x00ff00U);
}

void fill_span(std::uint32_t* first, std::uint32_t* last, std::uint32_t colour_argb) {
    const std::uint32_t alpha = colour_argb >> 24U;
    if (alpha == 255U) {
        std::fill(first, last, colour_argb);
        return;
    }
    for (; first != last; ++first) *first = blend(*first, colour_argb, alpha);
}

// The first pixel whose centre is at or beyond `coordinate`.
int first_pixel(float coordinate) {
    return static_cast<int>(std::ceil(coordinate - 0.5F));
}

float edge_x(const ImVec2& upper, const ImVec2& lower, float y) {
    return upper.x + (lower.x - upper.x) * ((y - upper.y) / (lower.y - upper.y));
}

bool same(const ImVec2& a, const ImVec2& b) {
    return a.x == b.x && a.y == b.y;
}

// A quantity that is linear over a triangle: value at a pixel centre and its change per pixel.
class Plane {
  public:
    Plane(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c, float inverse_area,
          float value_a, float value_b, float value_c)
        : origin_(a.pos), value_(value_a) {
        const float to_b = value_b - value_a, to_c = value_c - value_a;
        dx_ = (to_b * (c.pos.y - a.pos.y) - to_c * (b.pos.y - a.pos.y)) * inverse_area;
        dy_ = (to_c * (b.pos.x - a.pos.x) - to_b * (c.pos.x - a.pos.x)) * inverse_area;
    }
    float at(float x, float y) const {
        return value_ + dx_ * (x - origin_.x) + dy_ * (y - origin_.y);
    }
    float per_pixel() const { return dx_; }

  private:
    ImVec2 origin_;
    float value_, dx_, dy_;
};

struct Span {
    int y, left, right;  // pixels [left, right)
};

// Calls `span(Span)` for each row of the triangle inside the clip.
template <typename ClipRect, typename Function>
void for_each_span(std::array<ImVec2, 3> p, const ClipRect& clip, const Function& function) {
    std::sort(p.begin(), p.end(),
              [](const ImVec2& a, const ImVec2& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
    const int top = std::max(first_pixel(p[0].y), clip.top);
    const int bottom = std::min(first_pixel(p[2].y), clip.bottom);
    for (int y = top; y < bottom; ++y) {
        const float centre = static_cast<float>(y) + 0.5F;
        const float along = edge_x(p[0], p[2], centre);
        const float bent =
            centre < p[1].y ? edge_x(p[0], p[1], centre) : edge_x(p[1], p[2], centre);
        const int left = std::max(first_pixel(std::min(along, bent)), clip.left);
        const int right = std::min(first_pixel(std::max(along, bent)), clip.right);
        if (left < right) function(Span{y, left, right});
    }
}

constexpr int kFixed = 16;  // fractional bits of a shaded channel

std::int32_t to_fixed(float channel) {
    return static_cast<std::int32_t>(std::clamp(channel, 0.0F, 255.0F) * 65536.0F) + (1 << 15);
}

// A channel along one row, in steps.
struct Ramp {
    std::int32_t value, step;

    Ramp(const Plane& plane, const Span& span)
        : value(to_fixed(
              plane.at(static_cast<float>(span.left) + 0.5F, static_cast<float>(span.y) + 0.5F))),
          step(static_cast<std::int32_t>(plane.per_pixel() * 65536.0F)) {}
    std::uint32_t next() {
        const std::int32_t whole = value >> kFixed;
        value += step;
        return static_cast<std::uint32_t>(std::clamp(whole, 0, 255));
    }
};

Plane channel_plane(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c,
                    float inverse_area, unsigned shift) {
    const auto channel = [shift](const ImDrawVert& vertex) {
        return static_cast<float>((vertex.col >> shift) & 0xffU);
    };
    return {a, b, c, inverse_area, channel(a), channel(b), channel(c)};
}

// One hue that fades: glows, shadows and every anti-aliased edge.
class Fading {
  public:
    Fading(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c, float inverse_area)
        : colour_(argb(a.col)), alpha_(channel_plane(a, b, c, inverse_area, 24)) {}

    void fill(std::uint32_t* row, const Span& span) const {
        Ramp alpha(alpha_, span);
        for (int x = span.left; x < span.right; ++x) {
            row[x] = blend(row[x], colour_, alpha.next());
        }
    }

  private:
    std::uint32_t colour_;
    Plane alpha_;
};

// All channels change.
class Shade {
  public:
    Shade(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c, float inverse_area)
        : red_(channel_plane(a, b, c, inverse_area, 0)),
          green_(channel_plane(a, b, c, inverse_area, 8)),
          blue_(channel_plane(a, b, c, inverse_area, 16)),
          alpha_(channel_plane(a, b, c, inverse_area, 24)),
          opaque_(((a.col & b.col & c.col) >> 24U) == 0xffU) {}

    void fill(std::uint32_t* row, const Span& span) const {
        Ramp red(red_, span), green(green_, span), blue(blue_, span), alpha(alpha_, span);
        const auto colour = [&] {
            return 0xff000000U | (red.next() << 16U) | (green.next() << 8U) | blue.next();
        };
        if (opaque_) {
            for (int x = span.left; x < span.right; ++x) row[x] = colour();
        } else {
            for (int x = span.left; x < span.right; ++x) {
                row[x] = blend(row[x], colour(), alpha.next());
            }
        }
    }

  private:
    Plane red_, green_, blue_, alpha_;
    bool opaque_;
};

ImDrawVert moved(ImDrawVert vertex, const ImDrawData& data) {
    vertex.pos.x = (vertex.pos.x - data.DisplayPos.x) * data.FramebufferScale.x;
    vertex.pos.y = (vertex.pos.y - data.DisplayPos.y) * data.FramebufferScale.y;
    return vertex;
}

}  // namespace

void Rasteriser::upload_fonts() {
    ImGuiIO& io = ImGui::GetIO();
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    unsigned char* pixels = nullptr;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &atlas_width_, &atlas_height_);
    atlas_.assign(pixels, pixels + atlas_width_ * atlas_height_);
}

void Rasteriser::clear(const PixelView& target, Colour colour) const {
    for (int y = 0; y < target.height; ++y) {
        std::uint32_t* row = target.pixels + y * target.stride;
        std::fill(row, row + target.width, argb(colour) | 0xff000000U);
    }
}

void Rasteriser::render(const ImDrawData& data, const PixelView& target) const {
    assert(!atlas_.empty());
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            if (command.UserCallback == nullptr) draw_command(list, command, data, target);
        }
    }
}

void Rasteriser::draw_command(const ImDrawList& list, const ImDrawCmd& command,
                              const ImDrawData& data, const PixelView& target) const {
    const auto pixel = [](float value, float offset, float scale) {
        return static_cast<int>(std::lround((value - offset) * scale));
    };
    const ImVec2 offset = data.DisplayPos, scale = data.FramebufferScale;
    const Clip clip{std::max(pixel(command.ClipRect.x, offset.x, scale.x), 0),
                    std::max(pixel(command.ClipRect.y, offset.y, scale.y), 0),
                    std::min(pixel(command.ClipRect.z, offset.x, scale.x), target.width),
                    std::min(pixel(command.ClipRect.w, offset.y, scale.y), target.height)};
    if (clip.left >= clip.right || clip.top >= clip.bottom) return;

    const ImDrawIdx* indices = list.IdxBuffer.Data + command.IdxOffset;
    const auto vertex = [&](unsigned i) {
        return moved(list.VtxBuffer[static_cast<int>(command.VtxOffset + indices[i])], data);
    };
    for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
        const ImDrawVert a = vertex(i), b = vertex(i + 1), c = vertex(i + 2);
        if (i + 5 < command.ElemCount && indices[i + 3] == indices[i] &&
            indices[i + 4] == indices[i + 2]) {
            const ImDrawVert d = vertex(i + 5);
            const ImDrawVert* corners[4] = {&a, &b, &c, &d};
            if (draw_rectangle(corners, clip, target)) {
                i += 3;
                continue;
            }
        }
        draw_triangle(a, b, c, clip, target);
    }
}

bool Rasteriser::draw_rectangle(const ImDrawVert* corners[4], const Clip& clip,
                                const PixelView& target) const {
    const ImDrawVert &a = *corners[0], &b = *corners[1], &c = *corners[2], &d = *corners[3];
    const bool upright = a.pos.y == b.pos.y && b.pos.x == c.pos.x && c.pos.y == d.pos.y &&
                         d.pos.x == a.pos.x && a.pos.x < c.pos.x && a.pos.y < c.pos.y;
    if (!upright || a.col != b.col || a.col != c.col || a.col != d.col) return false;

    const int left = std::max(first_pixel(a.pos.x), clip.left);
    const int right = std::min(first_pixel(c.pos.x), clip.right);
    const int top = std::max(first_pixel(a.pos.y), clip.top);
    const int bottom = std::min(first_pixel(c.pos.y), clip.bottom);
    const std::uint32_t colour = argb(a.col);
    const std::uint32_t alpha = colour >> 24U;
    const bool plain = same(a.uv, c.uv);
    const float texels_x = static_cast<float>(atlas_width_) / (c.pos.x - a.pos.x);
    const float texels_y = static_cast<float>(atlas_height_) / (c.pos.y - a.pos.y);
    const float step_u = (c.uv.x - a.uv.x) * texels_x, step_v = (c.uv.y - a.uv.y) * texels_y;
    for (int y = top; y < bottom; ++y) {
        std::uint32_t* row = target.pixels + y * target.stride;
        if (plain) {
            if (left < right) fill_span(row + left, row + right, colour);
            continue;
        }
        const float v = a.uv.y * static_cast<float>(atlas_height_) +
                        (static_cast<float>(y) + 0.5F - a.pos.y) * step_v;
        for (int x = left; x < right; ++x) {
            const float u = a.uv.x * static_cast<float>(atlas_width_) +
                            (static_cast<float>(x) + 0.5F - a.pos.x) * step_u;
            const std::uint32_t coverage = sample(u, v);
            if (coverage != 0) row[x] = blend(row[x], colour, coverage * alpha / 255U);
        }
    }
    return true;
}

void Rasteriser::draw_triangle(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c,
                               const Clip& clip, const PixelView& target) const {
    if (((a.col | b.col | c.col) >> 24U) == 0U) return;
    const float area =
        (b.pos.x - a.pos.x) * (c.pos.y - a.pos.y) - (c.pos.x - a.pos.x) * (b.pos.y - a.pos.y);
    // Not finite: a coordinate overflowed on its way here; there is nothing sensible to draw.
    if (area == 0.0F || !std::isfinite(area)) return;
    const float inverse_area = 1.0F / area;
    const std::array<ImVec2, 3> corners = {a.pos, b.pos, c.pos};
    const auto row = [&](int y) { return target.pixels + y * target.stride; };

    if (!same(a.uv, b.uv) || !same(a.uv, c.uv)) {
        const float w = static_cast<float>(atlas_width_), h = static_cast<float>(atlas_height_);
        const Plane u(a, b, c, inverse_area, a.uv.x * w, b.uv.x * w, c.uv.x * w);
        const Plane v(a, b, c, inverse_area, a.uv.y * h, b.uv.y * h, c.uv.y * h);
        const std::uint32_t colour = argb(a.col), alpha = colour >> 24U;
        for_each_span(corners, clip, [&](const Span& span) {
            for (int x = span.left; x < span.right; ++x) {
                const float px = static_cast<float>(x) + 0.5F;
                const float py = static_cast<float>(span.y) + 0.5F;
                const std::uint32_t coverage = sample(u.at(px, py), v.at(px, py));
                std::uint32_t& pixel = row(span.y)[x];
                pixel = blend(pixel, colour, coverage * alpha / 255U);
            }
        });
    } else if (a.col == b.col && a.col == c.col) {
        const std::uint32_t colour = argb(a.col);
        for_each_span(corners, clip, [&](const Span& span) {
            fill_span(row(span.y) + span.left, row(span.y) + span.right, colour);
        });
    } else if (((a.col ^ b.col) & 0xffffffU) == 0 && ((a.col ^ c.col) & 0xffffffU) == 0) {
        const Fading fading(a, b, c, inverse_area);
        for_each_span(corners, clip, [&](const Span& span) { fading.fill(row(span.y), span); });
    } else {
        const Shade shade(a, b, c, inverse_area);
        for_each_span(corners, clip, [&](const Span& span) { shade.fill(row(span.y), span); });
    }
}

std::uint32_t Rasteriser::sample(float u, float v) const {
    const float left = std::floor(u - 0.5F), top = std::floor(v - 0.5F);
    const auto share_x = static_cast<std::uint32_t>((u - 0.5F - left) * 256.0F);
    const auto share_y = static_cast<std::uint32_t>((v - 0.5F - top) * 256.0F);
    const int x0 = std::clamp(static_cast<int>(left), 0, atlas_width_ - 1);
    const int y0 = std::clamp(static_cast<int>(top), 0, atlas_height_ - 1);
    const int x1 = std::min(x0 + 1, atlas_width_ - 1), y1 = std::min(y0 + 1, atlas_height_ - 1);
    const auto texel = [&](int x, int y) -> std::uint32_t {
        return atlas_[static_cast<std::size_t>(y) * static_cast<std::size_t>(atlas_width_) +
                      static_cast<std::size_t>(x)];
    };
    const std::uint32_t upper = texel(x0, y0) * (256U - share_x) + texel(x1, y0) * share_x;
    const std::uint32_t lower = texel(x0, y1) * (256U - share_x) + texel(x1, y1) * share_x;
    return (upper * (256U - share_y) + lower * share_y) >> 16U;
}

}  // namespace fts::sdl
