#pragma once

#include <burnish/mesh.hpp>
#include <glm/glm.hpp>
#include <string_view>
#include <vector>

/// Meshes made by formula, with exact normals, uvs and tangents. Their bits are the same on every
/// machine. Winding is counter-clockwise seen from outside, every bitangent sign is +1, and
/// vertices that share a place (seams) have bit-identical positions. Generators throw
/// Error{bad_option} for counts below the stated least or sizes that are not positive and finite,
/// Error{limit} above 2^28 triangles.
namespace burnish::shapes {

/// Ellipsoid about the origin in a grid of longitude and latitude; its poles, on the y axis, are
/// one triangle per column: 2 * columns * (rows - 1) triangles. u runs eastward once around,
/// starting at the back (-z); v runs from the south pole (0) to the north pole (1). columns >= 3,
/// rows >= 2.
MeshData sphere(int columns, int rows, const glm::vec3& radii = glm::vec3(1.0F));

/// Measures of a torus knot, lengths in object space.
struct KnotShape {
    int turns_around_axis = 2;   ///< >= 1
    int turns_around_tube = 3;   ///< >= 0; without a common divisor with the above, a single knot
    float axis_radius = 1.0F;    ///< of the torus on which the curve lies
    float torus_radius = 0.45F;  ///< of that torus' tube, below axis_radius
    float tube_radius = 0.18F;   ///< of the knot itself
};

/// Tube around a torus knot about the z axis, 2 * segments * sides triangles. v runs once around
/// the tube, u along it, for as many whole periods as make texels nearly square. segments, sides
/// >= 3.
MeshData torus_knot(int segments, int sides, const KnotShape& shape = {});

/// Unit square in x and y about the origin, facing +z; uv runs from (0, 0) at its lower left to
/// (1, 1). 2 * columns * rows triangles, both >= 1.
MeshData plane(int columns, int rows);

/// Strip along y from -1 to 1, 1/2 wide in x, waving by 0.15 in z one and a half times, facing +z:
/// u runs along it, v across. 2 * columns * rows triangles, both >= 1.
MeshData ribbon(int columns, int rows);

/// Cube of side 1 about the origin, 12 triangles, 24 vertices; each side carries uv from (0, 0) to
/// (1, 1), upright on the four sides around y.
MeshData cube();

/// What `named` knows: "sphere", "knot", "plane", "cube", "ribbon".
std::vector<std::string_view> names();

/// The shape with that name: `columns` and `rows` of its grid, segments and sides of the knot,
/// neither for the cube. Throws Error{bad_option} for another name.
MeshData named(std::string_view name, int columns, int rows);

}  // namespace burnish::shapes
