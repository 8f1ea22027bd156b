#pragma once

#include <string>

#include "bench/peers/peer_scene.hpp"

namespace burnish::peers {

/// GLSL 4.50 of one shading, for OpenGL and for Vulkan, written for a software renderer: what is
/// linear is done per vertex, vectors are scaled by inversesqrt, and texels are decoded after the
/// dot product, not before. Vertices and uniforms are those of peer_inputs.hpp; textures are bound
/// by their unit, in Vulkan in set 1.
struct ShaderSources {
    std::string vertex, fragment;
};
ShaderSources shader_sources(Shading shading);

}  // namespace burnish::peers
