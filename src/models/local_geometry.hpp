#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "models/texel.hpp"

namespace burnish {

/// Where a picture looks at a surface. The viewer is far away, along the z axis.
struct LocalGeometry {
    glm::dvec3 t, b, n;  ///< the mesh's frame: unit, orthogonal
    glm::dvec2 uv;       ///< [0, 1), v downward
    glm::dvec2 jitter;   ///< [0, 1): where it lies between two points of a grid of vertices
    double weight;       ///< of the area that it stands for in the picture of a sphere
};

/// Pictures of a sphere with every direction of the tangent and every part of the maps, lit from
/// the unit vector `light`: `count` places that are seen and lit, fewer if they are hard to find.
///
/// Half of the half vectors are spread evenly around the material's normal, half over the octaves
/// of the distance from it, from 1/64 to 4 times the widths, so that narrow lobes are met in the
/// centre and on their edges as well. The sequence is J. Halton's (1960); the same bits everywhere.
std::vector<LocalGeometry> local_geometries(const TexelSource& source, const glm::dvec3& light,
                                            std::size_t count);

}  // namespace burnish
