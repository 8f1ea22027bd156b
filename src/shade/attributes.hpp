#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/aligned.hpp"
#include "geometry/triangle.hpp"
#include "kernels/kernel_table.hpp"
#include "shade/shading.hpp"

namespace burnish {

/// The first shading.interpolated() attributes of three corners.
using CornerAttributes = std::array<std::array<float, kMaxInterpolated>, 3>;

/// What the corners of a triangle hand to the interpolators: the rows of their vertices, with T and
/// B of the triangle itself where shading.frames_from_uv asks for it and uv have an area. They are
/// dP/du and dP/dv, v growing upward, in double precision, each normalised and rounded to float.
void corner_attributes(const Shading& shading, const ScreenMesh& mesh,
                       const SetupTriangle& triangle, CornerAttributes& out);

/// Arguments of attribute_planes on their way to the kernel.
struct PlaneInputs {
    std::vector<PlaneTriangle> triangles;
    // Where corners do not have what their vertices have, three rows for each triangle:
    AlignedVector<float> rows;
    std::vector<HomogeneousVertex> homogeneous;
};

/// Rows of AttributesCtx::equations.
inline std::size_t equation_rows(const Shading& shading) {
    return std::size_t{3} * (static_cast<std::size_t>(shading.interpolated()) + 1);
}

/// Equations of 1/w and of the shading.interpolated() attributes over w, for the window pixels of
/// up to kPacketSize triangles of a draw: AttributePlanesCtx. `equations` is
/// AttributesCtx::equations.
///
/// The three vertices span a plane through the eye in homogeneous window coordinates, so this holds
/// for triangles that were clipped too, with the vertices they had before; where nothing was cut
/// the snapped positions are used, so that every covered pixel centre interpolates, never
/// extrapolates. Method: M. Olano, T. Greer, "Triangle Scan Conversion using 2D Homogeneous
/// Coordinates", 1997.
void attribute_planes(const Shading& shading, const ScreenMesh& mesh,
                      std::span<const SetupTriangle* const> triangles, const KernelTable& kernels,
                      PlaneInputs& scratch, float* equations);

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
