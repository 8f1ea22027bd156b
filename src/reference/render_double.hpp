#pragma once

#include <burnish/framebuffer.hpp>
#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/parallel.hpp"
#include "core/tile_watch.hpp"
#include "reference/double_scene.hpp"
#include "reference/projected.hpp"
#include "reference/sample_pattern.hpp"

namespace burnish {

struct DoubleOptions {
    int samples = 1;         ///< per pixel: a square up to kMaxDoubleSamples; 1: the centre
    std::uint32_t seed = 1;  ///< of where samples lie, if there are several
    /// Whose material layer is looked up, coded as in its textures; nothing: materials are exact.
    std::optional<Machine> layer_machine = {};
    /// With a layer machine: also corners where it snaps them to, and texel coordinates in its
    /// steps of 1/256, downwards.
    bool machine_grid = false;
    FrameHooks hooks = {};
    reference::SurfaceCache* surfaces = nullptr;  ///< of the frames before; null: none
};
inline constexpr int kMaxDoubleSamples = 1024;

/// Draws `scene` by the formulas of its reflectance models into all of `target`, whose size sets
/// the resolution. A pixel is the mean of its samples; frames of floats get it as it is, others
/// clamped to 0 .. 1 and to the nearest code. The result does not depend on the number of workers.
/// Throws Error{bad_program} for what is not an opaque mesh with a reflectance model,
/// Error{bad_option} for a camera that sees nothing or for `samples`, Error{limit} if memory runs
/// out, Error{stopped} when the hooks say so. FrameStats::shaded_pixels counts samples.
FrameStats render_double(const Scene& scene, Framebuffer& target, WorkerPool& pool,
                         const DoubleOptions& options = {});

namespace reference {

/// Takes pixel (x, y): linear r, g, b, a. Called once for each, from any worker.
using PixelSink = std::function<void(int, int, const glm::dvec4&)>;

/// The same without frame: every pixel in double precision.
FrameStats render(const DoubleScene& scene, FrameSize size, const SamplePattern& pattern,
                  WorkerPool& pool, const PixelSink& sink, const FrameHooks& hooks = {});

}  // namespace reference
}  // namespace burnish
