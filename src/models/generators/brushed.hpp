#pragma once

#include <burnish/texture.hpp>
#include <cstdint>

namespace burnish {

/// The maps of brushed steel, all of one size, tileable in both directions.
///
/// The brush ran along the texture's u axis, so the tangent t lies along the marks and the
/// bitangent across them. Facets tilt across the marks much more than along them: the lobe is
/// narrow along t (alpha_x about 0.3) and wide along b (alpha_y about 0.75), and the highlight is
/// drawn out across the marks. (KHR_materials_anisotropy names the direction of the larger
/// roughness instead, which is our b.) Both widths vary from texel to texel.
///
/// Vectors are in tangent space, +Y up (towards smaller rows), coded clamp(floor(127.5 x + 128), 0,
/// 255), alpha 255. The tangent and bitangent maps hold t * map_scale / alpha_x and
/// b * map_scale / alpha_y with t and b perpendicular to the texel's normal, so that they can shade
/// without the normal map. The tangent map's alpha is the grey ks.
struct BrushedMaps {
    Image8 normal;
    Image8 tangent;
    Image8 bitangent;
    Image8 specular;         ///< rgb: tinted ks; alpha: grey ks
    float map_scale = 0.0F;  ///< 1, 1/2, 1/4 or 1/8: the largest that no map exceeds 1 with
};

/// Same maps for the same arguments on every machine. `size` is the side in texels, 1 .. 4096;
/// throws Error{bad_option} otherwise. The marks scale with the size, down to one texel.
BrushedMaps brushed_maps(std::uint32_t seed, int size);

}  // namespace burnish
