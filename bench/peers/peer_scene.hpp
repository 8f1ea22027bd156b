#pragma once

#include <burnish/scene.hpp>
#include <burnish/texture.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace burnish::peers {

/// What is computed for a fragment, apart from textures, light and numbers: one GLSL program each.
enum class Shading {
    modified,           ///< Model::abp_modified, ks from a map, half vector per vertex
    modified_constant,  ///< the same with one ks
    power,              ///< Model::abp, everything per pixel, s^(N/2) as a power
    table,              ///< the same with s^(N/2) from a table over s and N
    ward,               ///< Model::ward
    banks,              ///< Model::banks
    textured,           ///< one texture times a colour of the vertices
    flat,               ///< one colour
    layer,              ///< one texture with its alpha
    depth,              ///< nothing: the frame is the depths
};

/// Numbers that the programs of the peers take beside the scene's.
struct ShadingNumbers {
    float reach = 1.0F;          ///< of tangent and bitangent map: 1 / Material::map_scale
    float exponent_low = 0.0F;   ///< N = low + (high - low) * alpha of the specular map
    float exponent_high = 0.0F;  ///< and along the table's t
    float specular_scale = 1.0F;
};

/// A scene of the comparison, for burnish and in the same bytes for its peers.
struct PeerScene {
    std::string name;
    Shading shading = Shading::flat;
    /// Meshes only. Lights are one, directional, white, and its intensity is `intensity` of the
    /// call that made the scene.
    Scene scene;
    std::vector<TexturePtr> textures;  ///< by the units of the peers' program
    ShadingNumbers numbers;
    /// The double-precision renderer knows the formula, and filters as machines do.
    bool has_double = false;
    bool depth_buffer = true;  ///< the peers' frame has one
};

/// What docs/performance.md tabulates, in its order.
std::vector<std::string_view> scene_names();

/// @param intensity  of the light
/// Throws Error{bad_option} for an unknown name.
PeerScene peer_scene(std::string_view name, int width, int height, float intensity);

}  // namespace burnish::peers
