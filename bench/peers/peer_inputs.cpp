#include "bench/peers/peer_inputs.hpp"

#include "bench/peers/peer_textures.hpp"
#include "geometry/camera.hpp"

namespace burnish::peers {

std::vector<PeerVertex> vertices_of(const Mesh& mesh) {
    std::vector<PeerVertex> vertices;
    vertices.reserve(mesh.vertex_count());
    for (const VertexFrame& v : mesh.frames())
        vertices.push_back({v.position, v.normal, v.tangent, {v.uv.x, 1.0F - v.uv.y}});
    return vertices;
}

FrameBlock frame_block(const PeerScene& peer) {
    const Scene& scene = peer.scene;
    const View view = make_view(scene.camera, scene.width, scene.height);
    const Light& light = scene.lights.front();
    const ShadingNumbers& n = peer.numbers;
    return {glm::mat4(view.clip_from_world),
            glm::vec4(glm::vec3(view.eye), 1.0F),
            glm::vec4(glm::normalize(light.position), 0.0F),
            glm::vec4(light.intensity),
            {n.reach, n.exponent_low, n.exponent_high, n.specular_scale},
            glm::vec4(kLitTint, 1.0F),
            glm::vec4(kLitBase, 1.0F),
            glm::vec4(kFlatColor, 1.0F)};
}

}  // namespace burnish::peers
