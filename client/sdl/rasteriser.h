// Draws ImGui's draw data into memory, without a GPU: where SDL finds no accelerated renderer, and
// in tests. Sub-pixel exact like a GPU (a pixel is drawn when its centre is inside; triangles that
// share an edge leave neither gap nor overlap), so anti-aliased fringes and text look the same.
//
// Knows one texture, the font atlas of the current ImGui context. Not thread-safe.
#pragma once

#include <cstdint>
#include <vector>

#include <imgui.h>

#include "client/sdl/theme.h"

namespace fts::sdl {

// Pixels of somebody else's memory, 0xAARRGGBB each, opaque.
struct PixelView {
    std::uint32_t* pixels = nullptr;
    int width = 0;
    int height = 0;
    int stride = 0;  // pixels from one row to the next
};

class Rasteriser {
  public:
    // Reads the font atlas; call again whenever it was rebuilt.
    void upload_fonts();
    void clear(const PixelView& target, Colour colour) const;
    void render(const ImDrawData& data, const PixelView& target) const;

  private:
    struct Clip {
        int left, top, right, bottom;
    };
    void draw_command(const ImDrawList& list, const ImDrawCmd& command, const ImDrawData& data,
                      const PixelView& target) const;
    void draw_triangle(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c,
                       const Clip& clip, const PixelView& target) const;
    bool draw_rectangle(const ImDrawVert* corners[4], const Clip& clip,
                        const PixelView& target) const;
    // Coverage of the font atlas at texel coordinates, bilinear, [0, 255].
    std::uint32_t sample(float u, float v) const;

    std::vector<std::uint8_t> atlas_;
    int atlas_width_ = 0;
    int atlas_height_ = 0;
};

}  // namespace fts::sdl
