#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>

/// Surfaces with a grain, as functions of the texel. Each is a file of its own; all are made of
/// integer hashes, + - * / and sqrt, and core/dmath.hpp, so that they are the same everywhere.
///
/// The tangent runs along the marks, where the lobe is narrow; alpha_x belongs to it.
namespace burnish::generators {

struct SurfaceTexel {
    glm::dvec2 direction{1.0, 0.0};    ///< unit: of the marks, y towards smaller rows
    glm::dvec3 normal{0.0, 0.0, 1.0};  ///< unit, y towards smaller rows
    double alpha_x = 0.15, alpha_y = 0.45;
    double exponent = 16.0;
    glm::dvec3 kd{0.0}, ks{1.0};
};

/// Safe from several threads; 0 <= x, y < size.
using Surface = std::function<SurfaceTexel(int x, int y)>;

/// Straight marks of a brush along u; tileable.
Surface brushed(std::uint32_t seed, int size);
/// Turned on a lathe: marks run around the centre, against the clock.
Surface lathe(std::uint32_t seed, int size);
/// Honed: two families of straight strokes, 35 degrees to both sides of u; tileable.
Surface cross_hatch(std::uint32_t seed, int size);
/// The dial of a watch: marks run from the centre outwards.
Surface sunburst(std::uint32_t seed, int size);
/// An orbital sander's many small arcs; tileable.
Surface orbital(std::uint32_t seed, int size);
/// Brushed metal, patches of it rusty: parameters jump from texel to texel; tileable.
Surface corrosion(std::uint32_t seed, int size);
/// Polished metal with a greasy fingerprint, whose ridges are the marks.
Surface fingerprint(std::uint32_t seed, int size);
/// Plain weave of 16 by 16 yarns, warp along v and weft along u; tileable.
Surface weave(std::uint32_t seed, int size);

/// Texel centre from the centre of the texture, in texels, y towards smaller rows.
[[nodiscard]] inline glm::dvec2 from_centre(int x, int y, int size) {
    return {x + 0.5 - 0.5 * size, 0.5 * size - (y + 0.5)};
}

}  // namespace burnish::generators
