#pragma once

#include <burnish/renderer.hpp>

#include "app/command_line.hpp"

/// Several samples per pixel by drawing a larger picture and averaging it.
namespace burnish::app {

/// Renders `scene` with `side` x `side` samples per pixel into `target` by a box filter: at 16 bits
/// per channel (floats for a float target), rounded to nearest once. Vertices in window space are
/// scaled along. Throws Error{limit} if the larger picture exceeds Framebuffer::kMaxSize.
/// `shown` is drawn in place of colours.
FrameStats draw_supersampled(Renderer& renderer, const Scene& scene, int side, Framebuffer& target,
                             const std::optional<Shown>& shown = {});

}  // namespace burnish::app
