#pragma once

#include "geometry/triangle.hpp"
#include "kernels/packet_stages.hpp"
#include "shade/shading.hpp"

namespace burnish {

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

}  // namespace burnish
