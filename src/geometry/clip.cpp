#include "geometry/clip.hpp"

#include <cmath>

namespace burnish {

namespace {

constexpr int kPlanes = 6;

/// Signed distance times something positive; >= 0 inside.
double inside(const ClipVertex& v, int plane) {
    switch (plane) {
        case 0:
            return v.z;  // near
        case 1:
            return v.w - v.z;  // far
        case 2:
            return v.x - static_cast<double>(kGuardLow) * v.w;  // left
        case 3:
            return static_cast<double>(kGuardHigh) * v.w - v.x;  // right
        case 4:
            return v.y - static_cast<double>(kGuardLow) * v.w;  // top
        default:
            return static_cast<double>(kGuardHigh) * v.w - v.y;
    }
}

/// Where the edge from `in` (inside, distance d_in >= 0) to `out` (d_out < 0) meets the plane.
ClipVertex cut(const ClipVertex& in, double d_in, const ClipVertex& out, double d_out) {
    const double t = d_in / (d_in - d_out);
    return {in.x + (out.x - in.x) * t, in.y + (out.y - in.y) * t, in.z + (out.z - in.z) * t,
            in.w + (out.w - in.w) * t, -1};
}

ClipPolygon cut_polygon(const ClipPolygon& polygon, int plane) {
    ClipPolygon result;
    for (int i = 0; i < polygon.count; ++i) {
        const ClipVertex& a = polygon.corner[static_cast<std::size_t>(i)];
        const ClipVertex& b = polygon.corner[static_cast<std::size_t>((i + 1) % polygon.count)];
        const double da = inside(a, plane), db = inside(b, plane);
        // Rounded corners can change sides more often than those of a convex polygon: seen with
        // 3.4e38 beside 1e-45. The array must hold all the same.
        const auto add = [&](const ClipVertex& v) {
            if (result.count == ClipPolygon::kMaxCorners) return;
            result.corner[static_cast<std::size_t>(result.count++)] = v;
        };
        if (da >= 0.0) add(a);
        if (da >= 0.0 && db < 0.0) add(cut(a, da, b, db));
        if (da < 0.0 && db >= 0.0) add(cut(b, db, a, da));
    }
    return result;
}

ClipVertex corner(const HomogeneousVertex& v, int original) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z),
            static_cast<double>(v.w), original};
}

std::uint32_t frustum_bits(const HomogeneousVertex& h, const Viewport& viewport) {
    std::uint32_t bits = 0;
    if (h.x < 0.0F) bits |= Outcode::left;
    if (h.x > h.w * viewport.width) bits |= Outcode::right;
    if (h.y < 0.0F) bits |= Outcode::above;
    if (h.y > h.w * viewport.height) bits |= Outcode::below;
    if (h.z < 0.0F) bits |= Outcode::near;
    if (h.z > h.w) bits |= Outcode::far;
    return bits;
}

std::int32_t snap(float window, const Viewport& viewport) {
    const auto step = static_cast<std::int32_t>(256.0F / viewport.subpixels);
    return static_cast<std::int32_t>(std::floor(window * viewport.subpixels + viewport.snap_bias)) *
           step;
}

/// Outcodes and snapping, once the window position is known. Formulas: TransformCtx.
ScreenVertex screen_vertex(const HomogeneousVertex& h, float x, float y, float z,
                           const Viewport& viewport) {
    for (const float value : {h.x, h.y, h.z, h.w}) {
        if (!std::isfinite(value)) return {0, 0, 0.0F, Outcode::nonfinite};
    }
    std::uint32_t bits = frustum_bits(h, viewport);
    const bool in_band =
        h.w > 0.0F && x >= kGuardLow && x <= kGuardHigh && y >= kGuardLow && y <= kGuardHigh;
    if (!in_band) bits |= Outcode::guard;
    if ((bits & Outcode::needs_clip) != 0) return {0, 0, 0.0F, bits};
    return {snap(x, viewport), snap(y, viewport), z, bits};
}

}  // namespace

ClipPolygon clip_triangle(const HomogeneousVertex& v0, const HomogeneousVertex& v1,
                          const HomogeneousVertex& v2) {
    ClipPolygon polygon;
    polygon.corner[0] = corner(v0, 0);
    polygon.corner[1] = corner(v1, 1);
    polygon.corner[2] = corner(v2, 2);
    polygon.count = 3;
    for (int plane = 0; plane < kPlanes && polygon.count > 0; ++plane) {
        polygon = cut_polygon(polygon, plane);
    }
    if (polygon.count < 3) polygon.count = 0;
    return polygon;
}

bool project(const ClipVertex& v, const Viewport& viewport, ScreenVertex& out) {
    if (!(v.w > 0.0)) return false;
    // Cut vertices may lie outside the band by a rounding error.
    constexpr double kSlack = 0.5;
    const double x = v.x / v.w, y = v.y / v.w, z = v.z / v.w;
    const auto in_range = [&](double c) {
        return c >= static_cast<double>(kGuardLow) - kSlack &&
               c <= static_cast<double>(kGuardHigh) + kSlack;
    };
    if (!in_range(x) || !in_range(y)) return false;
    const double clamped = z < 0.0 ? 0.0 : z > 1.0 ? 1.0 : z;
    out = {snap(static_cast<float>(x), viewport), snap(static_cast<float>(y), viewport),
           static_cast<float>(clamped), 0};
    return true;
}

void place_clip_vertex(const float (&clip)[4], const Viewport& viewport, ScreenVertex& screen,
                       HomogeneousVertex& homogeneous) {
    homogeneous = {clip[0] * viewport.half_width + clip[3] * viewport.half_width,
                   clip[3] * viewport.half_height - clip[1] * viewport.half_height,
                   clip[2] * 0.5F + clip[3] * 0.5F, clip[3]};
    screen = screen_vertex(homogeneous, homogeneous.x / homogeneous.w,
                           homogeneous.y / homogeneous.w, homogeneous.z / homogeneous.w, viewport);
}

void place_window_vertex(const float (&window)[4], const Viewport& viewport, ScreenVertex& screen,
                         HomogeneousVertex& homogeneous) {
    const float w = window[3];
    homogeneous = {window[0] * w, window[1] * w, window[2] * w, w};
    screen = screen_vertex(homogeneous, window[0], window[1], window[2], viewport);
}

}  // namespace burnish
