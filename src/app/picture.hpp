#pragma once

#include <burnish/files.hpp>
#include <burnish/renderer.hpp>

#include "app/command_line.hpp"

/// From options to something that can be drawn.
namespace burnish::app {

/// Reads the input and applies every option. Notes of the loader go to standard error.
Scene load_picture(const PictureOptions& options);

/// Threads and instruction set. A renderer of them, made before any file is read, throws
/// Error{bad_option} for an ISA that is not there.
RendererOptions renderer_options(const PictureOptions& options);

/// Renders; what the scene cannot do counts as bad input, not as wrong usage.
FrameStats draw(Renderer& renderer, const Scene& scene, Framebuffer& target,
                const std::optional<Shown>& shown = {});

/// The camera turned about its focal point by `degrees` around its view-up direction.
Camera turned(const Camera& camera, float degrees);

}  // namespace burnish::app
