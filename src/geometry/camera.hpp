#pragma once

#include <burnish/scene.hpp>
#include <glm/glm.hpp>

#include "geometry/varyings.hpp"
#include "kernels/tile_stages.hpp"

namespace burnish {

/// A camera at one resolution.
struct View {
    glm::dmat4 clip_from_world;
    glm::dvec3 eye;   ///< world space
    glm::dvec3 back;  ///< from what it looks at towards it, world space
};

/// Eye to clip. Throws Error{bad_option} for angles or planes out of range.
glm::dmat4 projection_matrix(const Camera& camera, int width, int height);

/// Throws Error{bad_option} for a camera that sees nothing: equal position and focal point, an up
/// vector along the line of sight, angles or planes out of range, a matrix that has no inverse.
View make_view(const Camera& camera, int width, int height);

/// Pixels of a frame on the machine's vertex grid.
Viewport make_viewport(const Machine& machine, int width, int height);

/// Light and viewer in the space of an object. Throws Error{bad_option} if its matrix has no
/// inverse.
LightSpace light_space(const Light& light, const View& view, Viewer viewer,
                       const glm::mat4& world_from_object);

}  // namespace burnish
