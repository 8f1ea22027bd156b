#pragma once

#include <burnish/machine.hpp>
#include <burnish/scene.hpp>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/stage_bits.hpp"

/// Which stage of the shading a picture's error comes from: docs/attribution.md.
namespace burnish::lab {

/// The bits that a machine's own numbers have. Of wide ones they are near: registers have 2^14
/// steps, not 2^14 - 1, filters 8 bits of weight, tables interpolate.
StageBits machine_bits(const Machine& machine);

/// What one stage does to a picture, as root mean squares of differences from the exact one over
/// red, green and blue of the pixels with a surface.
struct StageError {
    std::string stage;  ///< "half_vector", "textures", "filter", "stage 0", .., "table", "frame"
    std::string text;   ///< of a general stage: what it does in the first object's program
    int bits = kExactBits;    ///< that it has
    double only = 0.0;        ///< it alone is rounded
    double bias = 0.0;        ///< mean difference then, positive where the picture is brighter
    double all_but = 0.0;     ///< all others are rounded
    double cumulative = 0.0;  ///< it is rounded and all before it are
};

struct Attribution {
    std::size_t pixels = 0;  ///< with a surface
    std::vector<StageError> stages;
    double all = 0.0;       ///< all stages are rounded
    double all_bias = 0.0;  ///< mean difference then
    /// The exact picture against the model's formula in double precision: corners on the machine's
    /// grid, half vectors of the vertices, where tables end. Nothing for programs.
    std::optional<double> plan;
    double machine = 0.0;  ///< the machine's own picture against the exact one
    double rest = 0.0;     ///< and against that with all stages rounded: what no stage explains
};

/// Called after every picture with how many there are so far, and in all.
using AttributionProgress = std::function<void(std::size_t, std::size_t)>;

/// Three pictures for every stage, and three more. Throws what BitRenderer and Renderer do.
Attribution attribute_error(const Scene& scene, const StageBits& bits, int threads = 0,
                            const AttributionProgress& progress = {});

/// A pixel while its stages are rounded one after the other.
struct PixelStep {
    std::string stage;  ///< "exact" comes first
    glm::dvec3 color;   ///< with this stage and all before it rounded
    glm::dvec3 change;  ///< by this stage
};

struct PixelAttribution {
    std::vector<PixelStep> steps;
    glm::dvec3 machine;  ///< the pixel of the machine's own picture
};

/// Throws Error{bad_option} for a pixel outside the frame or without a surface, and what
/// BitRenderer and Renderer do.
PixelAttribution attribute_pixel(const Scene& scene, const StageBits& bits, int x, int y,
                                 int threads = 0);

}  // namespace burnish::lab
