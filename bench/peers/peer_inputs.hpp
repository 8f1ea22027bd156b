#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "bench/peers/peer_scene.hpp"

/// What the programs of shaders.hpp read, the same for every peer.
namespace burnish::peers {

/// A vertex, attributes 0 .. 3: that of the mesh, with v downward as textures have it.
struct PeerVertex {
    glm::vec3 position, normal;
    glm::vec4 tangent;
    glm::vec2 uv;
};
std::vector<PeerVertex> vertices_of(const Mesh& mesh);

/// The uniform block `Frame` of all programs, in the layout std140.
struct FrameBlock {
    glm::mat4 clip_from_object;  ///< z of -w .. w
    glm::vec4 eye;               ///< object space
    glm::vec4 light;             ///< unit, towards it, object space
    glm::vec4 intensity;         ///< of the light, in x
    glm::vec4 numbers;           ///< ShadingNumbers in order
    glm::vec4 lit_tint, lit_base, flat_color;
};
FrameBlock frame_block(const PeerScene& peer);

}  // namespace burnish::peers
