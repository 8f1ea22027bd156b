#pragma once

#include <array>
#include <cstdint>

#include "geometry/triangle.hpp"
#include "kernels/packet_stages.hpp"
#include "shade/shading.hpp"

namespace burnish {

/// The first shading.interpolated() attributes of three corners.
using CornerAttributes = std::array<std::array<float, kMaxInterpolated>, 3>;

/// What the corners of a triangle hand to the interpolators: vertex_attributes, with T and B of the
/// triangle itself where shading.frames_from_uv asks for it and uv have an area. They are dP/du and
/// dP/dv, v growing upward, in double precision, each normalised and rounded to float.
void corner_attributes(const Shading& shading, const ScreenMesh& mesh,
                       const SetupTriangle& triangle, CornerAttributes& out);

/// Plane equations of 1/w and of the attributes over w, for the window pixels of a triangle,
/// counted from its reference pixel. `out` holds shading.interpolated() + 1 planes.
///
/// The three vertices span a plane through the eye in homogeneous window coordinates, so this holds
/// for triangles that were clipped too, with the vertices they had before; where nothing was cut
/// the snapped positions are used, so that every covered pixel centre interpolates, never
/// extrapolates. Method: M. Olano, T. Greer, "Triangle Scan Conversion using 2D Homogeneous
/// Coordinates", 1997.
void attribute_planes(const Shading& shading, const ScreenMesh& mesh, const SetupTriangle& triangle,
                      AttributePlane* out);

/// Where a pixel lies in its triangle.
struct Barycentrics {
    std::array<double, 3> weight;  ///< of the corners, perspective-correct; they sum to 1
    double one_over_w;
};

/// At the centre of window pixel (x, y), in double precision and from the corners that the planes
/// are made from: what they are rounded from.
Barycentrics barycentrics(const ScreenMesh& mesh, const SetupTriangle& triangle, std::int32_t x,
                          std::int32_t y);

}  // namespace burnish
