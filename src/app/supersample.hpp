#pragma once

#include <burnish/renderer.hpp>

#include "app/command_line.hpp"

/// Several samples per pixel by drawing a larger picture and averaging it.
namespace burnish::app {

/// How many times larger a picture of `side` x `side` samples per pixel is drawn: the double
/// renderer takes its samples itself (RendererOptions::double_samples), so 1. Throws
/// Error{bad_option} for a machine and more than 4 x 4.
int enlargement(int side, const Scene& scene);

/// The larger picture: `scene` at `side` times its size, in 16 bits per channel, or floats if the
/// scene's format is that; of side 1 `scene` as it is. Vertices in window space are scaled along.
/// Throws Error{limit} if that exceeds Framebuffer::kMaxSize.
Scene enlarged(const Scene& scene, int side);

/// Means of side x side pixels, rounded to nearest once. `large` is what `enlarged` describes.
void shrink(const Framebuffer& large, int side, Framebuffer& target);

/// Renders `scene` with `side` x `side` samples per pixel into `target`, whose size and format
/// count, by a box filter. Throws what `enlarged` throws. `shown` is drawn in place of colours.
FrameStats draw_supersampled(Renderer& renderer, const Scene& scene, int side, Framebuffer& target,
                             const std::optional<Shown>& shown = {});

}  // namespace burnish::app
