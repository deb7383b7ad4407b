#include "client/sdl/im_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace fts::sdl {

ImRenderer::ImRenderer(SDL_Renderer& renderer) : renderer_(renderer) {
    ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
}

ImRenderer::~ImRenderer() {
    if (font_texture_ != nullptr) SDL_DestroyTexture(font_texture_);
}

bool ImRenderer::upload_fonts() {
    if (font_texture_ != nullptr) SDL_DestroyTexture(font_texture_);
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
    font_texture_ = SDL_CreateTexture(&renderer_, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STATIC,
                                      width, height);
    if (font_texture_ == nullptr) return false;
    SDL_UpdateTexture(font_texture_, nullptr, pixels, 4 * width);
    SDL_SetTextureBlendMode(font_texture_, SDL_BLENDMODE_BLEND);
    SDL_SetTextureScaleMode(font_texture_, SDL_ScaleModeLinear);
    atlas.SetTexID(font_texture_);
    return true;
}

void ImRenderer::render(const ImDrawData& data) {
    SDL_RenderSetScale(&renderer_, data.FramebufferScale.x, data.FramebufferScale.y);
    for (int i = 0; i < data.CmdListsCount; ++i) render_list(*data.CmdLists[i], data);
    SDL_RenderSetClipRect(&renderer_, nullptr);
    SDL_RenderSetScale(&renderer_, 1.0F, 1.0F);
}

void ImRenderer::render_list(const ImDrawList& list, const ImDrawData& data) {
    for (const ImDrawCmd& command : list.CmdBuffer) {
        if (command.UserCallback != nullptr) continue;
        const float left = std::max(command.ClipRect.x - data.DisplayPos.x, 0.0F);
        const float top = std::max(command.ClipRect.y - data.DisplayPos.y, 0.0F);
        const float right = std::min(command.ClipRect.z - data.DisplayPos.x, data.DisplaySize.x);
        const float bottom = std::min(command.ClipRect.w - data.DisplayPos.y, data.DisplaySize.y);
        if (right <= left || bottom <= top) continue;
        const auto whole = [](float value) { return static_cast<int>(std::lround(value)); };
        const SDL_Rect clip{whole(left), whole(top), whole(right - left), whole(bottom - top)};
        SDL_RenderSetClipRect(&renderer_, &clip);

        const ImDrawVert* vertices = list.VtxBuffer.Data + command.VtxOffset;
        const auto* bytes = reinterpret_cast<const std::byte*>(vertices);
        const auto floats = [&](std::size_t offset) {
            return reinterpret_cast<const float*>(bytes + offset);
        };
        constexpr int kStride = static_cast<int>(sizeof(ImDrawVert));
        const auto* colours = reinterpret_cast<const SDL_Color*>(bytes + offsetof(ImDrawVert, col));
        SDL_RenderGeometryRaw(&renderer_, static_cast<SDL_Texture*>(command.GetTexID()),
                              floats(offsetof(ImDrawVert, pos)), kStride, colours, kStride,
                              floats(offsetof(ImDrawVert, uv)), kStride,
                              list.VtxBuffer.Size - static_cast<int>(command.VtxOffset),
                              list.IdxBuffer.Data + command.IdxOffset,
                              static_cast<int>(command.ElemCount), sizeof(ImDrawIdx));
    }
}

}  // namespace fts::sdl
