// Draws ImGui's draw data with SDL_Renderer. For renderers that run on a GPU; SDL's own software
// renderer rounds vertices to whole pixels, which spoils every smooth edge (see rasteriser.h).
#pragma once

#include <SDL.h>
#include <imgui.h>

namespace fts::sdl {

class ImRenderer {
  public:
    // The SDL renderer must outlive this.
    explicit ImRenderer(SDL_Renderer& renderer);
    ~ImRenderer();
    ImRenderer(const ImRenderer&) = delete;
    ImRenderer& operator=(const ImRenderer&) = delete;

    // Uploads the font atlas; call again whenever it was rebuilt. False when SDL has no room for it
    // (SDL_GetError says why).
    bool upload_fonts();
    void render(const ImDrawData& data);

  private:
    void render_list(const ImDrawList& list, const ImDrawData& data);

    SDL_Renderer& renderer_;
    SDL_Texture* font_texture_ = nullptr;
};

}  // namespace fts::sdl
