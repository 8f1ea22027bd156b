#pragma once

#include <glm/glm.hpp>
#include <string>

#include "bench/peers/peer_scene.hpp"

namespace burnish::peers {

/// GLSL 4.50 of one shading, written for a software renderer: what is linear is done per vertex,
/// vectors are scaled by inversesqrt, and texels are decoded after the dot product, not before.
struct ShaderSources {
    std::string vertex, fragment;
};
ShaderSources shader_sources(Shading shading);

/// The uniform block `Frame` of all programs, in the layout std140.
struct FrameBlock {
    glm::mat4 clip_from_object;
    glm::vec4 eye;        ///< object space
    glm::vec4 light;      ///< unit, towards it, object space
    glm::vec4 intensity;  ///< of the light, in x
    glm::vec4 numbers;    ///< ShadingNumbers in order
    glm::vec4 lit_tint, lit_base, flat_color;
};

}  // namespace burnish::peers
