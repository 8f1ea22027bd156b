#pragma once

#include <burnish/experiment.hpp>
#include <burnish/framebuffer.hpp>
#include <burnish/scene.hpp>
#include <filesystem>
#include <glm/glm.hpp>

#include "lab/experiment/cells.hpp"

/// Pictures of an experiment, as frames of floats.
namespace burnish::lab {

/// The scene with its settings, a frame of floats. Throws what load_scene does.
Scene load_picture(const std::filesystem::path& file, const PictureSettings& picture);

/// The picture moved by `pixels` to the right and down, as an offset of the projection: parallax
/// and perspective stay as they are.
Scene moved(const Scene& scene, const glm::dvec2& pixels);

/// What all lights are to be multiplied by so that the largest channel of the interior is `peak`,
/// in double precision with a sample per pixel. Throws Error{bad_input} if all is black.
double exposure(const Scene& reference, double peak, int threads);
void scale_lights(Scene& scene, double factor);

/// Draws with `threads` workers, by render_with_bits if a setting speaks of bits; several samples
/// with Machine::double_precision only. Throws what Renderer::render and bits_of do.
Framebuffer draw_picture(const Scene& scene, const PictureSettings& picture, int threads);

}  // namespace burnish::lab
