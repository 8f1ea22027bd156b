#include "mesh/tangent.hpp"

#include <array>

#include "mesh/tangent_groups.hpp"
#include "mesh/weld.hpp"

namespace burnish {

std::vector<glm::vec4> corner_tangents(std::span<const glm::vec3> positions,
                                       std::span<const glm::vec3> normals,
                                       std::span<const glm::vec2> uvs) {
    check_tangent_limit(positions.size());
    Weld same = weld(positions.size(), [&](std::size_t i) {
        const glm::vec3 &p = positions[i], &n = normals[i];
        return std::array{key_bits(p.x), key_bits(p.y), key_bits(p.z),      key_bits(n.x),
                          key_bits(n.y), key_bits(n.z), key_bits(uvs[i].x), key_bits(uvs[i].y)};
    });
    WeldedTriangles mesh;
    for (const std::uint32_t i : same.first) {
        mesh.positions.push_back(positions[i]);
        mesh.normals.push_back(normals[i]);
        mesh.uvs.push_back(uvs[i]);
    }
    mesh.indices = std::move(same.id);
    const TangentGroups groups = tangent_groups(mesh);
    std::vector<glm::vec4> tangents;
    tangents.reserve(positions.size());
    for (const std::uint32_t group : groups.group_of_corner)
        tangents.push_back(groups.tangent_of_group[group]);
    return tangents;
}

}  // namespace burnish
