#include "tests/client_sdl/offscreen.h"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "client/sdl/screenshot.h"
#include "client/sdl/window.h"

namespace fts::sdl {
namespace {}  // namespace

Offscreen::Offscreen(int width_px, int height_px, float pixel_ratio)
    : width_(width_px), height_(height_px), ratio_(pixel_ratio) {
    ImGui::CreateContext();
    apply_style();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(width_px), static_cast<float>(height_px)};
    io.DisplayFramebufferScale = {pixel_ratio, pixel_ratio};
    // Any slot serves as long as each key has its own.
    for (int key = 0; key < ImGuiKey_COUNT; ++key) io.KeyMap[key] = key + 1;
    type_ = build_type_scale(unit_for(io.DisplaySize), pixel_ratio);
    rasteriser_.upload_fonts();
    pixels_.resize(static_cast<std::size_t>(drawn(width_px)) *
                   static_cast<std::size_t>(drawn(height_px)));
}

Offscreen::~Offscreen() {
    ImGui::DestroyContext();
}

void Offscreen::press_key(int imgui_key) {
    keys_.push_back(imgui_key);
}

void Offscreen::click(ImVec2 at) {
    ImGui::GetIO().MousePos = at;
    click_step_ = 3;
}

void Offscreen::frame(double time_s, const std::function<void(Canvas&)>& draw) {
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = 1.0F / 60.0F;
    for (const int key : keys_) io.KeysDown[io.KeyMap[key]] = true;
    io.MouseDown[0] = click_step_ == 2;
    click_step_ = std::max(click_step_ - 1, 0);
    ImGui::NewFrame();
    Canvas canvas{ImGui::GetBackgroundDrawList(), io.DisplaySize, type_, time_s};
    draw(canvas);
    ImGui::Render();
    for (const int key : keys_) io.KeysDown[io.KeyMap[key]] = false;
    keys_.clear();
    stale_ = true;
}

void Offscreen::rasterise() const {
    if (!stale_) return;
    stale_ = false;
    const PixelView target{pixels_.data(), drawn(width_), drawn(height_), drawn(width_)};
    rasteriser_.clear(target, palette::kBackground);
    rasteriser_.render(*ImGui::GetDrawData(), target);
}

Colour Offscreen::pixel(ImVec2 at) const {
    rasterise();
    const auto x = static_cast<std::size_t>(at.x * ratio_);
    const auto y = static_cast<std::size_t>(at.y * ratio_);
    const auto row = static_cast<std::size_t>(drawn(width_));
    return rgb(pixels_.at(y * row + x) & 0xffffffU);
}

int Offscreen::count_glyphs(bool outside_only) const {
    const ImDrawData& data = *ImGui::GetDrawData();
    const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
    int count = 0;
    for (int list = 0; list < data.CmdListsCount; ++list) {
        for (const ImDrawVert& vertex : data.CmdLists[list]->VtxBuffer) {
            if (vertex.uv.x == white.x && vertex.uv.y == white.y) continue;
            const bool outside = vertex.pos.x < 0 || vertex.pos.y < 0 ||
                                 vertex.pos.x > static_cast<float>(width_) ||
                                 vertex.pos.y > static_cast<float>(height_);
            if (outside || !outside_only) ++count;
        }
    }
    return (count + 3) / 4;
}

int Offscreen::glyphs_outside() const {
    return count_glyphs(true);
}
int Offscreen::glyphs() const {
    return count_glyphs(false);
}

double Offscreen::drawn_share() const {
    rasterise();
    const std::uint32_t background = 0xff0a1020U;
    const auto drawn =
        std::ranges::count_if(pixels_, [&](std::uint32_t pixel) { return pixel != background; });
    return static_cast<double>(drawn) / static_cast<double>(pixels_.size());
}

std::size_t Offscreen::triangles() const {
    return static_cast<std::size_t>(ImGui::GetDrawData()->TotalIdxCount) / 3;
}

void Offscreen::keep(const std::string& name) const {
    const char* folder = std::getenv("FTS_FRAMES");
    if (folder == nullptr) return;
    rasterise();
    std::string error;
    EXPECT_TRUE(write_png({pixels_.data(), drawn(width_), drawn(height_), drawn(width_)},
                          std::string(folder) + "/" + name + "-" + std::to_string(height_) + ".png",
                          error))
        << error;
}

}  // namespace fts::sdl
