#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/packet.hpp"

/// Arguments of the stages before shading. Contract header: plain data, no functions.
namespace burnish {

/// A vertex on the screen, as triangle setup wants it.
struct ScreenVertex {
    std::int32_t x, y;      ///< window coordinates in 1/256 pixel, snapped to the machine's grid
    float z;                ///< window depth, [0, 1] between the near and the far plane
    std::uint32_t outcode;  ///< Outcode bits
};

/// The same vertex before the division: window coordinates times w.
struct HomogeneousVertex {
    float x, y;  ///< pixels * w
    float z;     ///< depth * w
    float w;
};

/// Bits of ScreenVertex::outcode. x and y of ScreenVertex hold only while no bit from `near` on is
/// set; otherwise they are 0.
struct Outcode {
    static constexpr std::uint32_t left = 1;         ///< window x < 0
    static constexpr std::uint32_t right = 2;        ///< window x > width
    static constexpr std::uint32_t above = 4;        ///< window y < 0
    static constexpr std::uint32_t below = 8;        ///< window y > height
    static constexpr std::uint32_t near = 16;        ///< depth < 0
    static constexpr std::uint32_t far = 32;         ///< depth > 1
    static constexpr std::uint32_t guard = 64;       ///< x or y outside the guard band, or w <= 0
    static constexpr std::uint32_t nonfinite = 128;  ///< a NaN or an infinity
    static constexpr std::uint32_t frustum = 63;     ///< all in one such bit: not visible
    static constexpr std::uint32_t needs_clip = 16 | 32 | 64;
};

/// Guard band in pixels: vertices outside are clipped. Inside, |edge coefficients| stay below 2^24.
inline constexpr float kGuardLow = -8192.0F;
inline constexpr float kGuardHigh = 24575.0F;

/// clip -> window of one frame: window x * w = clip.x * half_width + clip.w * half_width,
/// y * w = clip.w * half_height - clip.y * half_height, z * w = clip.z * 0.5 + clip.w * 0.5.
struct Viewport {
    float half_width, half_height;  ///< pixels
    float width, height;            ///< pixels
    float subpixels;                ///< grid steps per pixel, 2^subpixel_bits: 16 .. 256
    float snap_bias;                ///< 0.5 to snap to the nearest step, 0 to snap downwards
};

/// Object space to the screen, `count` vertices. All arithmetic in float, no operation fused, in
/// the order written here:
///   clip_i = ((x * m[i] + y * m[4 + i]) + z * m[8 + i]) + m[12 + i]      (column-major m)
///   homogeneous as in Viewport (each product rounded, then the sum), its z as ScreenVertex z * w
///   window x = homogeneous x / w, y and z likewise
///   screen x = int(floor(window x * subpixels + snap_bias)) * (256 / subpixels), y likewise
/// Outcode: nonfinite alone if any of the four homogeneous values is NaN or infinite. Otherwise
/// left: hx < 0, right: hx > w * width, above: hy < 0, below: hy > w * height, near: hz < 0,
/// far: hz > w, guard: !(w > 0) or a window x or y outside [kGuardLow, kGuardHigh].
/// With any of near .. nonfinite set, screen x, y and z are 0.
struct TransformCtx {
    const float* x;  ///< object space, readable to the next multiple of 16
    const float* y;
    const float* z;
    int count;
    float m[16];  ///< clip from object, column-major
    Viewport viewport;
    ScreenVertex* screen;            ///< out, `count` elements
    HomogeneousVertex* homogeneous;  ///< out, `count` elements
};

/// Pixels, inclusive; empty if x0 > x1 or y0 > y1.
struct PixelRect {
    std::int16_t x0, y0, x1, y1;
};

/// A triangle with everything that tiles need, stored once: a cache line. Edge i runs from corner i
/// to the next; edge functions are made of the corners, tile by tile.
struct alignas(64) SetupTriangle {
    std::int32_t x[3], y[3];  ///< window, 1/256 pixel; ordered so that the area is positive
    PixelRect box;            ///< pixels whose centres it may cover, cut to the frame
    float z, zx, zy;          ///< depth at the centre of the reference pixel, and per pixel
    float z_low, z_high;      ///< range of the corners
    std::int16_t reference_x, reference_y;  ///< pixel inside the frame, near the triangle
    std::uint32_t number;                   ///< of the draw's triangles, in the order of submission
    std::uint32_t draw : 30;
    std::uint32_t swapped : 1;  ///< x, y have the second corner and the third exchanged
    std::uint32_t clipped : 1;  ///< x, y are not those of the triangle's vertices
};
static_assert(sizeof(SetupTriangle) == 64);

/// A tiny triangle's box holds at most this many pixel centres both ways, before it is cut to the
/// frame. Its coverage is a mask: bit kTinySize * y + x for the pixel at (x, y) from the upper left
/// one of its box.
inline constexpr int kTinySize = 8;

/// A small triangle's corners are at most this many pixels apart, both ways.
inline constexpr int kSmallSize = kTileSize;

/// What became of the triangles that `setup` was given.
struct SetupCounts {
    std::int32_t taken;  ///< triangles before the first that has to be clipped
    std::int32_t drawn;  ///< of these, those that were written
    std::int32_t nonfinite, degenerate;
    PixelRect bounds;  ///< around the boxes of those drawn; of none {32767, 32767, -1, -1}
};

/// Where a triangle has to be drawn.
struct SetupPlace {
    std::uint64_t covered;  ///< of a tiny triangle, 0 of others
    std::uint16_t x, y;     ///< upper left pixel of the box
    /// 0: the triangle is small and its box lies in one tile; kLarge: it is not small.
    std::uint32_t tiles;
    static constexpr std::uint32_t kLarge = 0xffffffff;
};

/// Corners to triangles, in order, up to the first triangle that has to be clipped. A triangle is
/// looked at in this order:
///   a corner with `nonfinite`: counted, not drawn; all corners with the same bit of `frustum`: not
///   drawn; a corner with a bit of `needs_clip`: setup stops before it;
///   area = (x1 - x0) (y2 - y0) - (y1 - y0) (x2 - x0), exact: 0 is counted, not drawn; neither is
///   one with a sign that is dropped; below 0 the second corner and the third are exchanged;
///   box: pixels with centres at 256 i + 128 from the least to the greatest coordinate, both
///   included, cut to the frame; empty: not drawn;
///   tiny: `covered` is its coverage, and without a pixel it is not drawn. A centre
///   on an edge is inside if the edge is a left one (y falls from corner i to the next) or a top
///   one (level, x rises);
///   reference pixel: (x >> 8, y >> 8) of the corner with the greatest z, the first of several, cut
///   to the frame;
///   depth, in double, corner 0 at (x0, y0, z0), all products and sums rounded, none fused:
///     x1 = double(difference to x0), likewise x2, y1, y2, dz1, dz2;  scale = 256 / |area|
///     zx = (dz1 * y2 - dz2 * y1) * scale,  zy = (dz2 * x1 - dz1 * x2) * scale
///     z = (z0 + ((reference_x + 0.5) - x0 / 256) * zx) + ((reference_y + 0.5) - y0 / 256) * zy
///   and rounded to float; z_low and z_high are the first of the least and greatest z.
struct SetupCtx {
    const ScreenVertex* vertices;
    const std::uint32_t* indices;               ///< three per triangle
    std::int32_t count;                         ///< triangles
    std::uint32_t number, draw;                 ///< number of the first triangle; draw < 2^30
    std::int32_t width, height;                 ///< frame, pixels
    std::uint8_t drop_positive, drop_negative;  ///< areas, y down
    SetupTriangle* triangles;                   ///< out, room for count + 1
    SetupPlace* places;                         ///< out, room for count + 1
    SetupCounts* counts;                        ///< out
};

/// A triangle in the list of a tile.
struct TileEntry {
    std::uint64_t covered;   ///< pixels of a tiny triangle in this tile, 0 of others
    std::uint32_t triangle;  ///< index into those of its chunk
    std::uint8_t x, y;       ///< tile pixel of the mask's bit 0
    std::uint8_t is_large;   ///< 1: not small
};

/// What a fragment of a draw has to pass: 1: a new depth <, ==, > the old one passes; and whether
/// it replaces the depth.
struct DepthRule {
    std::uint8_t pass_less, pass_equal, pass_greater, write;
};

/// What a mesh's vertex may hand to the interpolators, by number.
struct VertexValue {
    static constexpr std::int8_t none = -1;
    static constexpr std::int8_t half = 0;   ///< three components in the tangent frame,
    static constexpr std::int8_t light = 3;  ///< x/2 + 1/2
    static constexpr std::int8_t view = 6;
    static constexpr std::int8_t half_sum = 9;  ///< (l + v) / 2 in the tangent frame, not coded
    static constexpr std::int8_t n_dot_l = 12;
    static constexpr std::int8_t h_dot_l = 13;
    static constexpr std::int8_t lit = 14;     ///< three components: n_dot_l * tint + base
    static constexpr std::int8_t normal = 17;  ///< object space, x/2 + 1/2
    static constexpr std::int8_t uv = 20;      ///< u, 1 - v
    static constexpr std::int8_t frame = 22;   ///< tangent, bitangent, normal and position
    static constexpr int count = 34;
};

/// A light at `count` vertices. All arithmetic in float, no operation fused, dot(a, b) =
/// (ax bx + ay by) + az bz, unit(x) = x * (1 / sqrt(dot(x, x))) or, without length, x:
///   b = cross(n, t) * sign;   orthonormal: n = unit(n), t = unit(t - n * dot(n, t)),
///                             c = cross(n, t), b = dot(c, b) < 0 ? -c : c
///   l = unit(light - position * light_w),  v = unit(eye - position * eye_w),  sum = l + v
///   h = raw_half ? sum * 0.5 : unit(sum)
///   half = (dot(t, h), dot(b, h), dot(n, h)) * 0.5 + 0.5, light and view likewise of l and v
///   half_sum = (dot(t, sum * 0.5), ...)
///   n_dot_l = max(dot(n, l), 0), h_dot_l = max(dot(h, l), 0): 0 for a NaN
///   normal = (n as it came) * 0.5 + 0.5
///   frame = t, cross(n, t) * sign, n and position as they came
struct LightVerticesCtx {
    static constexpr int kFrameFloats = 12;
    const float* frames;  ///< kFrameFloats each: position, normal, tangent and its sign, uv
    int count;
    float light[3], light_w;
    float eye[3], eye_w;
    std::uint8_t orthonormal, raw_half;
    float tint[3], base[3];
    const std::int8_t* values;  ///< `stride` VertexValues; `none` leaves a float as it is
    int stride;
    float* out;  ///< vertex by vertex, `stride` floats each
};

/// A triangle whose attributes are to be interpolated.
struct PlaneTriangle {
    std::int32_t x[3], y[3];                ///< corners, window, 1/256 pixel, |x| < 2^24
    std::uint32_t vertex[3];                ///< the vertices at the corners
    std::int32_t reference_x, reference_y;  ///< pixel
    std::int32_t clipped;                   ///< 1: corners are where the vertices are, not x, y
};

/// Plane equations of 1/w and of attributes over w, for pixels of the window counted from the
/// triangle's reference pixel, as AttributesCtx takes them. In double, no operation fused, sums of
/// products from the left; origin, dx and dy are rounded to float at the end:
///   v_i = ((x_i / 256 - cx) * w, (y_i / 256 - cy) * w, w), cx = reference_x + 0.5, cy likewise, w
///   of the homogeneous vertex; clipped: (hx - cx * w, hy - cy * w, w)
///   b_0 = cross(v_1, v_2), b_1 = cross(v_2, v_0), b_2 = cross(v_0, v_1), with
///   cross(a, b) = (a.y * b.w - a.w * b.y, a.w * b.x - a.x * b.w, a.x * b.y - a.y * b.x)
///   s = 1 / (v_0.x * b_0.x + v_0.y * b_0.y + v_0.w * b_0.w), then b_i = b_i * s
///   of corner values a_i: origin = a_0 * b_0.w + a_1 * b_1.w + a_2 * b_2.w, dx likewise with b.x,
///   dy with b.y; equation 0 has a_i = 1
/// Where s is not finite the triangle is seen edge-on: origin = a_0, dx = dy = 0.
struct AttributePlanesCtx {
    const PlaneTriangle* triangles;
    int count;  ///< 1 .. kPacketSize
    const HomogeneousVertex* homogeneous;
    const float* rows;  ///< attributes of vertex v at rows + v * row_stride, readable 3 past a row
    std::ptrdiff_t row_stride;
    int attribute_count;
    float* equations;  ///< out: as AttributesCtx has them, writable 16 past the last triangle
};

/// A triangle as one tile sees it. Inside where a*x + b*y + c >= 0 for every edge, for whole tile
/// pixels x, y in 0 .. 63; c includes the top-left rule. Edges that do not cross the tile are left
/// out, so |c| < 2^30 and the sum fits 32 bits.
struct TileTriangle {
    std::int32_t a[3], b[3], c[3];
    std::int32_t edges;               ///< 0 .. 3
    std::int32_t x0, y0, x1, y1;      ///< bounding box in tile pixels, inclusive, 0 .. 63
    float z, zx, zy;                  ///< depth at the reference pixel, and per pixel
    float z_low, z_high;              ///< range of the triangle's vertices
    std::int32_t offset_x, offset_y;  ///< tile pixel (0, 0) minus the reference pixel
    std::uint32_t id;                 ///< what the visibility buffer keeps; not kNoTriangle
    std::uint8_t pass_less, pass_equal, pass_greater;  ///< 1: new depth <, ==, > old passes
    std::uint8_t depth_write;                          ///< 1: a passing fragment replaces the depth
};

/// Sets words, as a tile's depths and ids are before anything is drawn.
struct ClearWordsCtx {
    void* to;  ///< out, `count` words
    std::uint32_t value;
    int count;  ///< a multiple of 16
};

/// Coverage and depth of `count` triangles, in order. Per covered pixel
///   depth = clamp((z + dx * zx) + dy * zy, z_low, z_high), dx = float(x + offset_x), dy likewise
/// in float, no operation fused; where the depth test passes, `id` and (with depth_write) `depth`
/// are replaced. Equal depths compare equal; there are no NaNs.
/// `block_far[k]` is an upper bound of the depths of block k, kept up to date; kernels may skip a
/// block by it only where no fragment of it could pass. Bit k of a triangle's `drawn` tells whether
/// a fragment of it passed in block k. Depths alone: where `id` is null there are no ids, and
/// `drawn` is left as it is.
struct RasterizeCtx {
    const TileTriangle* triangles;
    int count;
    float* depth;          ///< kTilePixels
    std::uint32_t* id;     ///< kTilePixels, or null
    float* block_far;      ///< kTileBlocks
    std::uint64_t* drawn;  ///< out, `count` elements
};

/// The same for triangles as setup and a tile's list have them, `count` entries of the list: for
/// rasterize_tiny tiny ones, whose coverage is their mask; for rasterize_small small ones, which
/// cover pixels whose centres are inside as SetupCtx has it, whatever the mask, and are looked at
/// beyond the frame as well where they reach there.
/// The ids are first_id and those that follow; offset_x of the TileTriangle would be
/// left - reference_x. Pixels of a mask lie inside the tile, boxes reach into it. The reference
/// pixel of a small triangle is as SetupCtx has it, a corner's, cut to the frame.
inline constexpr int kMostEntries = 32768;
struct RasterizeEntriesCtx {
    const TileEntry* entries;
    int count;  ///< at most kMostEntries
    const SetupTriangle* triangles;
    DepthRule rule;
    std::int32_t left, top;  ///< pixel of the frame at the tile's corner
    std::uint32_t first_id;
    float* depth;          ///< kTilePixels, and one more that may hold anything afterwards
    std::uint32_t* id;     ///< likewise; null: depths alone
    float* block_far;      ///< kTileBlocks
    std::uint64_t* drawn;  ///< out, `count` elements; unused without ids
    /// Of rasterize_small with ids alone, kTileBlocks each: 1: nothing was drawn in the block yet,
    /// whose depths are 1 and whose ids are kNoTriangle, whatever is stored. Blocks may be written
    /// whole and get a 0; what stays 1 stays as it is.
    std::uint8_t *blank_depths, *blank_ids;
};

/// One triangle's coverage and depth as RasterizeCtx has them, for draws that need order: in place
/// of an id every pixel of the bounding box that passes sets its bit, bit i of word k for pixel
/// 64 k + i. Depths outside the bounding box may be anything afterwards.
struct CoverCtx {
    const TileTriangle* triangle;
    float* depth;           ///< kTilePixels
    float* block_far;       ///< kTileBlocks
    std::uint64_t* passed;  ///< out, kTileBlocks; words without a bit are not written
    std::uint64_t* blocks;  ///< out: bit k: passed[k] is not 0
};

/// Visible fragments of a tile, triangle after triangle, block after block, rising in each block.
/// The visibility buffer shows triangles 0 .. count - 1; where it shows something else, nothing is
/// listed.
struct CollectCtx {
    const std::uint32_t* id;     ///< kTilePixels
    const std::uint64_t* drawn;  ///< per triangle, as RasterizeCtx has it: all blocks that show it
    int count;
    std::uint16_t* pixels;  ///< out: tile indices, room for kTilePixels + 16; the rest is garbage
    /// Out: triangle k has pixels first[k] .. first[k + 1] - 1; one more number of scratch behind.
    std::uint32_t* first;
};

}  // namespace burnish
