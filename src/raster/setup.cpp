#include "raster/setup.hpp"

#include <algorithm>

namespace burnish {

namespace {

constexpr std::int32_t kCentre = 128;  // window units: half a pixel

/// Value of an edge at the centre of pixel (0, 0) of the frame, |value| < 2^41. In units of 1/65536
/// the values at pixel centres differ by multiples of 256, so dividing by 256, rounding down, keeps
/// their signs. Pixels on an edge belong to the triangle if it is a left edge (the inside lies to
/// its right) or a top edge (level, the inside below): the top-left rule.
std::int64_t edge_origin(const SetupTriangle& t, int from, int to) {
    const std::int64_t a = t.y[from] - t.y[to], b = t.x[to] - t.x[from];
    const bool top_left = a > 0 || (a == 0 && b > 0);
    const std::int64_t value = a * (kCentre - t.x[from]) + b * (kCentre - t.y[from]);
    return (value - (top_left ? 0 : 1)) >> 8;
}

}  // namespace

bool tile_triangle(const SetupTriangle& t, std::int32_t tile_x, std::int32_t tile_y,
                   TileTriangle& out) {
    const std::int32_t left = tile_x * kTileSize, top = tile_y * kTileSize;
    constexpr std::int32_t kLast = kTileSize - 1;
    int edges = 0;
    for (int i = 0; i < 3; ++i) {
        const int next = i < 2 ? i + 1 : 0;
        const std::int32_t a = t.y[i] - t.y[next], b = t.x[next] - t.x[i];
        const std::int64_t c = edge_origin(t, i, next) + static_cast<std::int64_t>(a) * left +
                               static_cast<std::int64_t>(b) * top;
        const std::int32_t across = a * kLast, down = b * kLast;
        if (c + std::max(across, 0) + std::max(down, 0) < 0) return false;
        out.a[edges] = a;
        out.b[edges] = b;
        out.c[edges] = static_cast<std::int32_t>(c);
        // Kept, and not overwritten by the next one, only if it crosses the tile.
        edges += c + std::min(across, 0) + std::min(down, 0) < 0 ? 1 : 0;
    }
    out.edges = edges;
    out.x0 = std::max(t.box.x0 - left, 0);
    out.y0 = std::max(t.box.y0 - top, 0);
    out.x1 = std::min(t.box.x1 - left, kLast);
    out.y1 = std::min(t.box.y1 - top, kLast);
    if (out.x0 > out.x1 || out.y0 > out.y1) return false;
    out.z = t.z;
    out.zx = t.zx;
    out.zy = t.zy;
    out.z_low = t.z_low;
    out.z_high = t.z_high;
    out.offset_x = left - t.reference_x;
    out.offset_y = top - t.reference_y;
    return true;
}

bool covers_tile(const SetupTriangle& t, std::int32_t tile_x, std::int32_t tile_y,
                 FrameSize frame) {
    const std::int32_t left = tile_x * kTileSize, top = tile_y * kTileSize;
    const PixelRect& box = t.box;
    const bool in_box = box.x0 <= left && box.y0 <= top &&
                        box.x1 >= std::min(left + kTileSize, frame.width) - 1 &&
                        box.y1 >= std::min(top + kTileSize, frame.height) - 1;
    TileTriangle seen;
    return in_box && tile_triangle(t, tile_x, tile_y, seen) && seen.edges == 0;
}

}  // namespace burnish
