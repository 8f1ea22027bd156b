#include "view/gui_draw.hpp"

#include <imgui.h>

#include <burnish/error.hpp>
#include <string>

namespace burnish::view {
namespace {

const float* floats(const ImVec2& v) {
    return &v.x;
}

void draw_list(const ImDrawList& list, const ImVec2& origin, SDL_Renderer* renderer) {
    const int vertices = list.VtxBuffer.Size;
    for (const ImDrawCmd& command : list.CmdBuffer) {
        if (command.UserCallback != nullptr || command.ElemCount == 0) continue;
        const SDL_Rect clip{static_cast<int>(command.ClipRect.x - origin.x),
                            static_cast<int>(command.ClipRect.y - origin.y),
                            static_cast<int>(command.ClipRect.z - command.ClipRect.x),
                            static_cast<int>(command.ClipRect.w - command.ClipRect.y)};
        if (clip.w <= 0 || clip.h <= 0) continue;
        SDL_RenderSetClipRect(renderer, &clip);
        const ImDrawVert* first = list.VtxBuffer.Data + command.VtxOffset;
        SDL_RenderGeometryRaw(
            renderer, static_cast<SDL_Texture*>(command.GetTexID()), floats(first->pos),
            sizeof(ImDrawVert), reinterpret_cast<const SDL_Color*>(&first->col), sizeof(ImDrawVert),
            floats(first->uv), sizeof(ImDrawVert), vertices - static_cast<int>(command.VtxOffset),
            list.IdxBuffer.Data + command.IdxOffset, static_cast<int>(command.ElemCount),
            sizeof(ImDrawIdx));
    }
}

}  // namespace

SDL_Texture* make_font_texture(SDL_Renderer* renderer) {
    unsigned char* pixels = nullptr;
    int width = 0;
    int height = 0;
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.GetTexDataAsRGBA32(&pixels, &width, &height);
    SDL_Texture* texture = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_ABGR8888,
                                             SDL_TEXTUREACCESS_STATIC, width, height);
    if (texture == nullptr)
        throw Error(ErrorCode::io, std::string("view: no texture for the font: ") + SDL_GetError());
    SDL_UpdateTexture(texture, nullptr, pixels, 4 * width);
    SDL_SetTextureBlendMode(texture, SDL_BLENDMODE_BLEND);
    fonts.SetTexID(texture);
    return texture;
}

void draw_gui(const ImDrawData& data, SDL_Renderer* renderer) {
    for (int i = 0; i < data.CmdListsCount; ++i)
        draw_list(*data.CmdLists[i], data.DisplayPos, renderer);
    SDL_RenderSetClipRect(renderer, nullptr);
}

}  // namespace burnish::view
