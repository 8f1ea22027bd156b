#pragma once

#include <burnish/materials.hpp>
#include <burnish/scene.hpp>
#include <burnish/texture.hpp>

/// Widths of lobes as glTF's KHR_materials_anisotropy says them, both ways.
///
/// With alpha = roughness^2, the extension widens the lobe along one direction:
///   along it  alpha + (1 - alpha) strength^2,   across it  alpha.
/// Its direction is that of the *larger* width: across the marks of a brush. Ours is that of
/// alpha_x, whichever is larger. Angles are counted from u against the clock as one looks at the
/// texture: 90 degrees is up, towards smaller rows, in both.
/// Source: Khronos Group, KHR_materials_anisotropy, README.
namespace burnish {

struct GltfAnisotropy {
    double roughness = 1.0;  ///< [0, 1]
    double strength = 0.0;   ///< [0, 1]
    double rotation = 0.0;   ///< radians, from the tangent to the direction of larger width
};

struct LobeWidths {
    double alpha_x = 1.0, alpha_y = 1.0;  ///< [0, 1]
    double direction = 0.0;  ///< radians, from u to the tangent, to which alpha_x belongs
};

/// alpha_x is the larger width; the direction is the rotation.
LobeWidths widths_from_gltf(const GltfAnisotropy& anisotropy);

/// A tangent along the smaller width gives a rotation 90 degrees on. Lines have no sense, so the
/// rotation is in (-pi/2, pi/2]; it is 0 for equal widths.
GltfAnisotropy gltf_from_widths(const LobeWidths& widths);

/// Our maps of a glTF material.
struct AnisotropyMaps {
    Image8 direction;  ///< r, g: VectorEncoding::d
    Image8 alpha;      ///< r, g: alpha_x and alpha_y in their ranges
    CodedRange alpha_x_range, alpha_y_range;
};

/// `anisotropy`: r, g the direction, (n / 127.5 - 1), b the strength; multiplied and turned by the
/// factors. `roughness`: g multiplies the factor, as in metallicRoughnessTexture; empty for none.
/// Throws Error{bad_input} unless both are of one size, at least 1 x 1.
AnisotropyMaps anisotropy_maps_from_gltf(const Image8& anisotropy, const Image8& roughness,
                                         const GltfAnisotropy& factors);

/// Textures for a glTF material with roughnessFactor 1, anisotropyStrength 1 and no rotation.
struct GltfAnisotropyMaps {
    Image8 anisotropy;  ///< anisotropyTexture
    Image8 roughness;   ///< metallicRoughnessTexture: g roughness, b metallic, 1
};

/// One texel for a material without maps. Throws Error{bad_program} as TexelSource does.
GltfAnisotropyMaps gltf_anisotropy_maps(const Material& material);

}  // namespace burnish
