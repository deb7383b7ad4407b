// A window without a window: frames drawn into memory, for tests to look into. Where FTS_FRAMES
// names a folder, frames can be kept there as PNG files for people to look at.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "client/sdl/canvas.h"
#include "client/sdl/rasteriser.h"

namespace fts::sdl {

class Offscreen {
  public:
    Offscreen(int width_px, int height_px, float pixel_ratio = 1.0F);
    ~Offscreen();
    Offscreen(const Offscreen&) = delete;
    Offscreen& operator=(const Offscreen&) = delete;

    // One frame at `time_s`. ImGui needs two to settle a screen that has just appeared.
    void frame(double time_s, const std::function<void(Canvas&)>& draw);
    void press_key(int imgui_key);  // held during the next frame only
    void click(ImVec2 at);          // moves there, presses and releases over the next frames

    Colour pixel(ImVec2 at) const;  // 0xAABBGGRR
    // Glyphs of the last frame that reach beyond the window.
    int glyphs_outside() const;
    int glyphs() const;
    // Share of pixels that are not the window's background colour.
    double drawn_share() const;
    std::size_t triangles() const;
    void keep(const std::string& name) const;

    int width() const { return width_; }
    int height() const { return height_; }

  private:
    int count_glyphs(bool outside_only) const;
    // Into pixels_, when somebody wants to see them.
    void rasterise() const;
    int drawn(int length_px) const {
        return static_cast<int>(static_cast<float>(length_px) * ratio_);
    }

    int width_, height_;
    float ratio_;
    TypeScale type_;
    Rasteriser rasteriser_;
    mutable std::vector<std::uint32_t> pixels_;
    mutable bool stale_ = true;
    std::vector<int> keys_;
    int click_step_ = 0;
};

}  // namespace fts::sdl
