#pragma once

#include <burnish/scene.hpp>
#include <optional>

namespace burnish {

/// An ellipsoid of 2 * columns * (rows - 1) triangles over 60 % of a frame of 16:9; the modified
/// model with three maps, tiled 4 x 2 so that a texel is about a pixel of 1920 x 1080: what two
/// combiners and three units did.
Scene ellipsoid_scene(int columns, int rows, int width, int height);

/// The same in anisotropic Blinn-Phong on `ideal`, N from 8 to 16: five maps' worth of words.
Scene lobe_scene(int columns, int rows, int width, int height);

struct Layers {
    int count = 8;
    std::optional<Blend> blend = {};
    int texture = 512;     ///< texels, both ways
    float degrees = 0.0F;  ///< by which the texture is turned
};

/// Layers over the whole frame, back to front, of one texture with a texel for each pixel.
Scene layers_scene(const Layers& layers, int width, int height);

}  // namespace burnish
