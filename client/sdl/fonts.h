// The type scale: one rasterised font per text style, sharp at the window's present size.
#pragma once

#include <array>
#include <string>

#include <imgui.h>

#include "client/sdl/theme.h"

namespace fts::sdl {

struct TypeScale {
    std::array<ImFont*, kTextStyleCount> fonts{};
    float unit = 1.0F;  // window pixels per unit

    ImFont* font(TextStyle style) const { return fonts[static_cast<std::size_t>(style)]; }
    float size_px(TextStyle style) const {
        return kTextUnits[static_cast<std::size_t>(style)] * unit;
    }
};

// Fills the current ImGui context's atlas anew; whoever renders must make its texture again.
// `pixel_ratio` is framebuffer pixels per window pixel (2 on a HiDPI screen). Takes Inter where it
// is installed, then DejaVu Sans, then the font built into ImGui.
TypeScale build_type_scale(float unit, float pixel_ratio);

// Pixels per unit for a window of this size.
float unit_for(ImVec2 window_size_px);

}  // namespace fts::sdl
