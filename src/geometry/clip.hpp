#pragma once

#include <array>
#include <cstdint>

#include "kernels/tile_stages.hpp"

namespace burnish {

/// Homogeneous window coordinates in double, as clipping makes them.
struct ClipVertex {
    double x, y, z, w;
    /// The vertex's own screen position where it is one of the triangle's, -1 for a new one.
    int original;
};

/// A triangle cut by six planes has at most nine corners.
struct ClipPolygon {
    static constexpr int kMaxCorners = 9;
    std::array<ClipVertex, kMaxCorners> corner;
    int count = 0;
};

/// Cuts a triangle by the near and the far plane and the four sides of the guard band, in this
/// order. Every cut goes from the inside to the outside, so two triangles that share an edge get
/// the same new vertices, bit for bit. The polygon is empty if nothing is left.
ClipPolygon clip_triangle(const HomogeneousVertex& v0, const HomogeneousVertex& v1,
                          const HomogeneousVertex& v2);

/// Divides by w and snaps, as the `transform` stage does. False if w is not positive or the point
/// is outside the range of window coordinates.
bool project(const ClipVertex& v, const Viewport& viewport, ScreenVertex& out);

/// The transform stage for a vertex that is already in homogeneous clip coordinates.
void place_clip_vertex(const float (&clip)[4], const Viewport& viewport, ScreenVertex& screen,
                       HomogeneousVertex& homogeneous);

/// The same for a vertex given in window coordinates: pixels, depth in [0, 1], clip w.
void place_window_vertex(const float (&window)[4], const Viewport& viewport, ScreenVertex& screen,
                         HomogeneousVertex& homogeneous);

}  // namespace burnish
