#pragma once

#include <burnish/experiment.hpp>
#include <burnish/framebuffer.hpp>
#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>

#include "lab/experiment/cells.hpp"
#include "lab/stage_bits.hpp"

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

/// Draws one side of a cell, frame after frame: what materials compile to is kept between them.
class Painter {
  public:
    /// `samples` with Machine::double_precision only; `threads` workers.
    Painter(const PictureSettings& picture, int samples, int threads);

    /// By render_with_bits if a setting speaks of bits. Throws what Renderer::render and bits_of
    /// do.
    Framebuffer draw(const Scene& scene);

  private:
    std::optional<StageBits> m_bits;
    int m_threads;
    Renderer m_renderer;
};

}  // namespace burnish::lab
