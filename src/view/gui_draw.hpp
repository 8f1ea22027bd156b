#pragma once

#include <SDL.h>

struct ImDrawData;

namespace burnish::view {

/// The font's picture as a texture of `renderer`, which Dear ImGui is told of. Throws Error{io}.
SDL_Texture* make_font_texture(SDL_Renderer* renderer);

/// Draws what Dear ImGui made of a frame with SDL's own geometry: the packaged library has no such
/// backend.
void draw_gui(const ImDrawData& data, SDL_Renderer* renderer);

}  // namespace burnish::view
