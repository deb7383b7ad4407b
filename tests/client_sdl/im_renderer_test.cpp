// The renderer for SDL's own renderers, on a surface: what it hands over must be what ImGui drew.
#include "client/sdl/im_renderer.h"

#include <gtest/gtest.h>

#include "tests/client_sdl/offscreen.h"

namespace fts::sdl {
namespace {

struct Surface {
    Surface(int width, int height)
        : surface(SDL_CreateRGBSurfaceWithFormat(0, width, height, 32, SDL_PIXELFORMAT_ARGB8888)),
          renderer(SDL_CreateSoftwareRenderer(surface)) {}
    ~Surface() {
        SDL_DestroyRenderer(renderer);
        SDL_FreeSurface(surface);
    }
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    Colour pixel(int x, int y) const {
        const auto* row = static_cast<const std::uint8_t*>(surface->pixels) + y * surface->pitch;
        return rgb(reinterpret_cast<const std::uint32_t*>(row)[x] & 0xffffffU);
    }

    SDL_Surface* surface;
    SDL_Renderer* renderer;
};

void draw_sample(Canvas& canvas) {
    canvas.list->AddRectFilled({0, 0}, canvas.size, rgb(0x102030));
    canvas.list->AddRectFilled({20, 20}, {80, 60}, rgb(0xff0000));
    canvas.list->PushClipRect({100, 20}, {140, 60});
    canvas.list->AddRectFilled({0, 0}, canvas.size, rgb(0x00ff00));
    canvas.list->PopClipRect();
    canvas.text({20, 80}, TextStyle::kTitle, rgb(0xffffff), "Ink");
}

TEST(ImRenderer, draws_shapes_clips_and_text_where_imgui_put_them) {
    Offscreen reference(200, 150);
    Surface surface(200, 150);
    ImRenderer renderer(*surface.renderer);
    ASSERT_TRUE(renderer.upload_fonts()) << SDL_GetError();
    reference.frame(0.0, draw_sample);
    renderer.render(*ImGui::GetDrawData());
    SDL_RenderFlush(surface.renderer);

    for (const auto& [x, y] : {std::pair{50, 40}, {10, 10}, {120, 40}, {120, 70}, {180, 40}}) {
        EXPECT_EQ(surface.pixel(x, y),
                  reference.pixel({static_cast<float>(x), static_cast<float>(y)}))
            << x << ", " << y;
    }
    int bright = 0;
    for (int y = 80; y < 125; ++y) {
        for (int x = 20; x < 90; ++x) bright += (surface.pixel(x, y) & 0xffU) > 0x80U ? 1 : 0;
    }
    EXPECT_GT(bright, 100);
}

}  // namespace
}  // namespace fts::sdl
