#pragma once

#include <burnish/files.hpp>
#include <burnish/renderer.hpp>

#include "app/command_line.hpp"

/// From options to something that can be drawn.
namespace burnish::app {

/// Reads the input and applies every option. Notes of the loader go to standard error.
Scene load_picture(const PictureOptions& options);

/// Throws Error{bad_option} for an ISA that is not there, before any file is read.
/// `double_samples`: as in RendererOptions.
/// `accounting`: as well.
Renderer make_renderer(const PictureOptions& options, int double_samples = 1,
                       bool accounting = false);

/// Renders; what the scene cannot do counts as bad input, not as wrong usage.
FrameStats draw(Renderer& renderer, const Scene& scene, Framebuffer& target,
                const std::optional<Shown>& shown = {});

/// The camera turned about its focal point by `degrees` around its view-up direction.
Camera turned(const Camera& camera, float degrees);

}  // namespace burnish::app
