#pragma once

#include <array>
#include <burnish/texture.hpp>
#include <glm/glm.hpp>

namespace burnish::reference {

/// Texel of `size` that stands at place `index` of an endless row: -1 .. size, where -1 and `size`
/// are the border of clamp_to_border and occur with no other mode.
int wrapped_texel(int index, int size, Wrap wrap);

/// The four texels around a point and how they are weighted.
struct Footprint {
    int left, right, top, bottom;
    double across, down;  ///< weights of the right and the lower ones, 0 .. 1

    /// Mean of texel(x, y).
    template <class Texel>
    [[nodiscard]] auto mean(Texel&& texel) const {
        return (texel(left, top) * (1.0 - across) + texel(right, top) * across) * (1.0 - down) +
               (texel(left, bottom) * (1.0 - across) + texel(right, bottom) * across) * down;
    }
};

/// What `sampler` looks at for `uv` in units of a texture of width x height: texel centres lie at
/// (i + 1/2) / size; without `linear` the nearest texel is all four. Coordinates that are not
/// finite count as 0.
Footprint footprint(const glm::dvec2& uv, int width, int height, const Sampler& sampler,
                    bool linear);

/// A texel centre and what of the result comes from there.
struct WeightedPoint {
    glm::dvec2 uv;
    double weight;
};

/// The centres of the texels that footprint() weights, wherever wrapping puts them: what a filter
/// after shading looks at. Of a nearest texel it is the centre four times, the first with weight 1.
std::array<WeightedPoint, 4> texel_centres(const glm::dvec2& uv, int width, int height,
                                           bool linear);

}  // namespace burnish::reference
