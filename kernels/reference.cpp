#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "kernels/kernel_table.hpp"
#include "kernels/log2_steps.hpp"

/// The scalar reference of every stage: one pixel at a time, each line the definition from
/// docs/numbers.md or from the comment of the stage's argument. It decides what the vector kernels
/// must give, bit for bit, so nothing here is written for speed.
namespace burnish {
namespace {

using Int = std::int64_t;

// The minimum and maximum of the contract: a NaN in `a` yields `b`.
float minimum(float a, float b) {
    return a < b ? a : b;
}
float maximum(float a, float b) {
    return a > b ? a : b;
}

Int clamp(Int x, Int low, Int high) {
    return std::min(std::max(x, low), high);
}

/// Quotient rounded to nearest, for divisors that leave no ties. divisor > 0 and odd.
Int divide_to_nearest(Int x, Int divisor) {
    const Int magnitude = ((x < 0 ? -x : x) * 2 + divisor) / (2 * divisor);
    return x < 0 ? -magnitude : magnitude;
}

/// Quotient by 2^bits, rounded half up.
Int shift_half_up(Int x, int bits) {
    return (x + (Int{1} << (bits - 1))) >> bits;
}

int tile_x(int pixel) {
    return pixel / kBlockPixels % (kTileSize / kBlockSize) * kBlockSize + pixel % kBlockSize;
}
int tile_y(int pixel) {
    return pixel / kBlockPixels / (kTileSize / kBlockSize) * kBlockSize +
           pixel % kBlockPixels / kBlockSize;
}

int tile_index(int x, int y) {
    const int block = y / kBlockSize * (kTileSize / kBlockSize) + x / kBlockSize;
    return block * kBlockPixels + y % kBlockSize * kBlockSize + x % kBlockSize;
}

// ---- stages before shading

std::uint32_t outcode(const HomogeneousVertex& v, const Viewport& viewport) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w))
        return Outcode::nonfinite;
    std::uint32_t code = 0;
    if (v.x < 0.0F) code |= Outcode::left;
    if (v.x > v.w * viewport.width) code |= Outcode::right;
    if (v.y < 0.0F) code |= Outcode::above;
    if (v.y > v.w * viewport.height) code |= Outcode::below;
    if (v.z < 0.0F) code |= Outcode::near;
    if (v.z > v.w) code |= Outcode::far;
    const auto outside = [&](float window) { return window < kGuardLow || window > kGuardHigh; };
    if (!(v.w > 0.0F) || outside(v.x / v.w) || outside(v.y / v.w)) code |= Outcode::guard;
    return code;
}

void transform(const TransformCtx& ctx) noexcept {
    const float* m = ctx.m;
    const Viewport& port = ctx.viewport;
    for (int k = 0; k < ctx.count; ++k) {
        float clip[4];
        for (int i = 0; i < 4; ++i)
            clip[i] = ((ctx.x[k] * m[i] + ctx.y[k] * m[4 + i]) + ctx.z[k] * m[8 + i]) + m[12 + i];
        HomogeneousVertex& h = ctx.homogeneous[k];
        h.x = clip[0] * port.half_width + clip[3] * port.half_width;
        h.y = clip[3] * port.half_height - clip[1] * port.half_height;
        h.z = clip[2] * 0.5F + clip[3] * 0.5F;
        h.w = clip[3];

        ScreenVertex& s = ctx.screen[k];
        s = {0, 0, 0.0F, outcode(h, port)};
        if ((s.outcode & (Outcode::needs_clip | Outcode::nonfinite)) != 0) continue;
        const auto snap = [&](float window) {
            const float step = std::floor(window * port.subpixels + port.snap_bias);
            return static_cast<std::int32_t>(step) *
                   (256 / static_cast<std::int32_t>(port.subpixels));
        };
        s.x = snap(h.x / h.w);
        s.y = snap(h.y / h.w);
        s.z = h.z / h.w;
    }
}

/// Whether the centre of the pixel lies inside, with the top-left rule.
bool covers(const SetupTriangle& t, int x, int y) {
    for (int i = 0; i < 3; ++i) {
        const int next = (i + 1) % 3;
        const Int a = t.y[i] - t.y[next], b = t.x[next] - t.x[i];
        const Int value = a * (256 * x + 128 - t.x[i]) + b * (256 * y + 128 - t.y[i]);
        const bool top_left = a > 0 || (a == 0 && b > 0);
        if (value < 0 || (value == 0 && !top_left)) return false;
    }
    return true;
}

/// First and last pixel whose centre lies from `low` to `high`.
Int first_pixel(Int low) {
    return (low - 128 + 255) >> 8;
}
Int last_pixel(Int high) {
    return (high - 128) >> 8;
}

void depth_plane(const ScreenVertex (&v)[3], Int area, SetupTriangle& out) {
    const double z0 = static_cast<double>(v[0].z);
    const double dz1 = static_cast<double>(v[1].z) - z0, dz2 = static_cast<double>(v[2].z) - z0;
    const double x1 = v[1].x - v[0].x, y1 = v[1].y - v[0].y;
    const double x2 = v[2].x - v[0].x, y2 = v[2].y - v[0].y;
    const double scale = 256.0 / static_cast<double>(area);
    const double zx = (dz1 * y2 - dz2 * y1) * scale, zy = (dz2 * x1 - dz1 * x2) * scale;
    const double dx = out.reference_x + 0.5 - v[0].x / 256.0;
    const double dy = out.reference_y + 0.5 - v[0].y / 256.0;
    out.z = static_cast<float>(z0 + dx * zx + dy * zy);
    out.zx = static_cast<float>(zx);
    out.zy = static_cast<float>(zy);
    out.z_low = std::min({v[0].z, v[1].z, v[2].z});
    out.z_high = std::max({v[0].z, v[1].z, v[2].z});
}

/// Whether the triangle is drawn. Corners need no clipping.
bool set_up(const SetupCtx& ctx, ScreenVertex (&v)[3], SetupCounts& counts, SetupTriangle& out,
            SetupPlace& place) {
    const Int area =
        Int{v[1].x - v[0].x} * (v[2].y - v[0].y) - Int{v[1].y - v[0].y} * (v[2].x - v[0].x);
    if (area == 0) {
        ++counts.degenerate;
        return false;
    }
    if ((area > 0 ? ctx.drop_positive : ctx.drop_negative) != 0) return false;
    out.swapped = area < 0 ? 1 : 0;
    if (area < 0) std::swap(v[1], v[2]);
    for (int i = 0; i < 3; ++i) {
        out.x[i] = v[i].x;
        out.y[i] = v[i].y;
    }
    const auto [x_low, x_high] = std::minmax({v[0].x, v[1].x, v[2].x});
    const auto [y_low, y_high] = std::minmax({v[0].y, v[1].y, v[2].y});
    const Int x0 = first_pixel(x_low), x1 = last_pixel(x_high);
    const Int y0 = first_pixel(y_low), y1 = last_pixel(y_high);
    out.box = {static_cast<std::int16_t>(std::max(x0, Int{0})),
               static_cast<std::int16_t>(std::max(y0, Int{0})),
               static_cast<std::int16_t>(std::min(x1, Int{ctx.width} - 1)),
               static_cast<std::int16_t>(std::min(y1, Int{ctx.height} - 1))};
    if (out.box.x0 > out.box.x1 || out.box.y0 > out.box.y1) return false;
    const bool small = x_high - x_low <= 256 * kSmallSize && y_high - y_low <= 256 * kSmallSize;
    place = {
        0, static_cast<std::uint16_t>(out.box.x0), static_cast<std::uint16_t>(out.box.y0),
        static_cast<std::uint32_t>(!small || out.box.x0 / kTileSize != out.box.x1 / kTileSize ||
                                   out.box.y0 / kTileSize != out.box.y1 / kTileSize)};
    const bool tiny = x1 - x0 < kTinySize && y1 - y0 < kTinySize;
    for (int y = out.box.y0; tiny && y <= out.box.y1; ++y) {
        for (int x = out.box.x0; x <= out.box.x1; ++x) {
            const int bit = kTinySize * (y - out.box.y0) + x - out.box.x0;
            if (covers(out, x, y)) place.covered |= std::uint64_t{1} << bit;
        }
    }
    if (tiny && place.covered == 0) return false;
    const ScreenVertex& farthest = *std::max_element(
        v, v + 3, [](const ScreenVertex& a, const ScreenVertex& b) { return a.z < b.z; });
    out.reference_x = static_cast<std::int16_t>(clamp(farthest.x >> 8, 0, ctx.width - 1));
    out.reference_y = static_cast<std::int16_t>(clamp(farthest.y >> 8, 0, ctx.height - 1));
    depth_plane(v, area < 0 ? -area : area, out);
    return true;
}

void setup(const SetupCtx& ctx) noexcept {
    SetupCounts& counts = *ctx.counts = {};
    PixelRect& bounds = counts.bounds = {32767, 32767, -1, -1};
    for (; counts.taken < ctx.count; ++counts.taken) {
        ScreenVertex v[3];
        for (int i = 0; i < 3; ++i) v[i] = ctx.vertices[ctx.indices[3 * counts.taken + i]];
        const std::uint32_t any = v[0].outcode | v[1].outcode | v[2].outcode;
        if ((any & Outcode::nonfinite) != 0) {
            ++counts.nonfinite;
            continue;
        }
        if ((v[0].outcode & v[1].outcode & v[2].outcode & Outcode::frustum) != 0) continue;
        if ((any & Outcode::needs_clip) != 0) return;
        SetupTriangle triangle{};
        if (!set_up(ctx, v, counts, triangle, ctx.places[counts.drawn])) continue;
        triangle.number = ctx.number + static_cast<std::uint32_t>(counts.taken);
        triangle.draw = ctx.draw & ((1U << 30) - 1);
        ctx.triangles[counts.drawn++] = triangle;
        bounds = {std::min(bounds.x0, triangle.box.x0), std::min(bounds.y0, triangle.box.y0),
                  std::max(bounds.x1, triangle.box.x1), std::max(bounds.y1, triangle.box.y1)};
    }
}

bool covers(const TileTriangle& t, int x, int y) {
    for (int e = 0; e < t.edges; ++e)
        if (Int{t.a[e]} * x + Int{t.b[e]} * y + t.c[e] < 0) return false;
    return true;
}

/// Of a TileTriangle or a DepthRun.
template <class Triangle>
float depth_at(const Triangle& t, int x, int y) {
    const auto dx = static_cast<float>(x + t.offset_x);
    const auto dy = static_cast<float>(y + t.offset_y);
    return minimum(maximum((t.z + dx * t.zx) + dy * t.zy, t.z_low), t.z_high);
}

/// A depth test, of TileTriangle or LateDepthCtx.
template <class Rule>
bool passes(const Rule& rule, float depth, float old) {
    return depth < old   ? rule.pass_less != 0
           : depth > old ? rule.pass_greater != 0
                         : rule.pass_equal != 0;
}

void clear_words(const ClearWordsCtx& ctx) noexcept {
    for (int i = 0; i < ctx.count; ++i)
        std::memcpy(static_cast<std::uint8_t*>(ctx.to) + 4 * i, &ctx.value, 4);
}

void rasterize(const RasterizeCtx& ctx) noexcept {
    for (int k = 0; k < ctx.count; ++k) {
        const TileTriangle& t = ctx.triangles[k];
        std::uint64_t drawn = 0;
        for (int y = t.y0; y <= t.y1; ++y) {
            for (int x = t.x0; x <= t.x1; ++x) {
                if (!covers(t, x, y)) continue;
                const int pixel = tile_index(x, y);
                const float depth = depth_at(t, x, y);
                if (!passes(t, depth, ctx.depth[pixel])) continue;
                if (ctx.id != nullptr) ctx.id[pixel] = t.id;
                drawn |= std::uint64_t{1} << pixel / kBlockPixels;
                if (t.depth_write != 0) ctx.depth[pixel] = depth;
            }
        }
        if (ctx.id != nullptr) ctx.drawn[k] = drawn;
    }
    for (int block = 0; block < kTileBlocks; ++block) {
        const float* depth = ctx.depth + block * kBlockPixels;
        ctx.block_far[block] = *std::max_element(depth, depth + kBlockPixels);
    }
}

/// Entry k of a tile's list at a pixel that it covers.
void draw_pixel(const RasterizeEntriesCtx& ctx, int k, int x, int y) {
    const SetupTriangle& triangle = ctx.triangles[ctx.entries[k].triangle];
    TileTriangle t{};
    t.z = triangle.z;
    t.zx = triangle.zx;
    t.zy = triangle.zy;
    t.z_low = triangle.z_low;
    t.z_high = triangle.z_high;
    t.offset_x = ctx.left - triangle.reference_x;
    t.offset_y = ctx.top - triangle.reference_y;
    const int pixel = tile_index(x, y);
    const float depth = depth_at(t, x, y);
    if (!passes(ctx.rule, depth, ctx.depth[pixel])) return;
    if (ctx.id != nullptr) {
        ctx.id[pixel] = ctx.first_id + static_cast<std::uint32_t>(k);
        ctx.drawn[k] |= std::uint64_t{1} << pixel / kBlockPixels;
    }
    if (ctx.rule.write == 0) return;
    ctx.depth[pixel] = depth;
    float& far = ctx.block_far[pixel / kBlockPixels];
    far = std::max(far, depth);
}

void rasterize_small(const RasterizeEntriesCtx& ctx) noexcept {
    for (int k = 0; k < ctx.count; ++k) {
        const SetupTriangle& t = ctx.triangles[ctx.entries[k].triangle];
        if (ctx.id != nullptr) ctx.drawn[k] = 0;
        const int last_x = std::min<int>(t.box.x1, ctx.left + kTileSize - 1),
                  last_y = std::min<int>(t.box.y1, ctx.top + kTileSize - 1);
        for (int y = std::max<int>(t.box.y0, ctx.top); y <= last_y; ++y) {
            for (int x = std::max<int>(t.box.x0, ctx.left); x <= last_x; ++x) {
                if (covers(t, x, y)) draw_pixel(ctx, k, x - ctx.left, y - ctx.top);
            }
        }
    }
}

void rasterize_tiny(const RasterizeEntriesCtx& ctx) noexcept {
    for (int k = 0; k < ctx.count; ++k) {
        const TileEntry& entry = ctx.entries[k];
        if (ctx.id != nullptr) ctx.drawn[k] = 0;
        for (int bit = 0; bit < kTinySize * kTinySize; ++bit) {
            if ((entry.covered >> bit & 1) != 0)
                draw_pixel(ctx, k, entry.x + bit % kTinySize, entry.y + bit / kTinySize);
        }
    }
}

void cover(const CoverCtx& ctx) noexcept {
    const TileTriangle& t = *ctx.triangle;
    std::uint64_t passed[kTileBlocks] = {};
    *ctx.blocks = 0;
    for (int y = t.y0; y <= t.y1; ++y) {
        for (int x = t.x0; x <= t.x1; ++x) {
            if (!covers(t, x, y)) continue;
            const int pixel = tile_index(x, y), block = pixel / kBlockPixels;
            const float depth = depth_at(t, x, y);
            if (!passes(t, depth, ctx.depth[pixel])) continue;
            passed[block] |= std::uint64_t{1} << pixel % kBlockPixels;
            if (t.depth_write != 0) ctx.depth[pixel] = depth;
        }
    }
    for (int block = 0; block < kTileBlocks; ++block) {
        const float* depth = ctx.depth + block * kBlockPixels;
        ctx.block_far[block] = *std::max_element(depth, depth + kBlockPixels);
        if (passed[block] == 0) continue;
        ctx.passed[block] = passed[block];
        *ctx.blocks |= std::uint64_t{1} << block;
    }
}

void collect(const CollectCtx& ctx) noexcept {
    std::uint16_t* out = ctx.pixels;
    for (int k = 0; k < ctx.count; ++k) {
        ctx.first[k] = static_cast<std::uint32_t>(out - ctx.pixels);
        for (int pixel = 0; pixel < kTilePixels; ++pixel) {
            const bool drawn = (ctx.drawn[k] >> pixel / kBlockPixels & 1) != 0;
            if (drawn && ctx.id[pixel] == static_cast<std::uint32_t>(k))
                *out++ = static_cast<std::uint16_t>(pixel);
        }
    }
    ctx.first[ctx.count] = static_cast<std::uint32_t>(out - ctx.pixels);
}

// ---- from triangles to registers

struct Homogeneous {
    double x, y, w;
};

Homogeneous cross(const Homogeneous& a, const Homogeneous& b) {
    return {a.y * b.w - a.w * b.y, a.w * b.x - a.x * b.w, a.x * b.y - a.y * b.x};
}

/// Corner i from the centre of the reference pixel.
Homogeneous plane_corner(const AttributePlanesCtx& ctx, const PlaneTriangle& t, int i) {
    const HomogeneousVertex& h = ctx.homogeneous[t.vertex[i]];
    const double w = static_cast<double>(h.w);
    const double centre_x = t.reference_x + 0.5, centre_y = t.reference_y + 0.5;
    if (t.clipped != 0) {
        return {static_cast<double>(h.x) - centre_x * w, static_cast<double>(h.y) - centre_y * w,
                w};
    }
    return {(t.x[i] / 256.0 - centre_x) * w, (t.y[i] / 256.0 - centre_y) * w, w};
}

void attribute_planes(const AttributePlanesCtx& ctx) noexcept {
    for (int k = 0; k < ctx.count; ++k) {
        const PlaneTriangle& t = ctx.triangles[k];
        const Homogeneous v[3] = {plane_corner(ctx, t, 0), plane_corner(ctx, t, 1),
                                  plane_corner(ctx, t, 2)};
        Homogeneous b[3] = {cross(v[1], v[2]), cross(v[2], v[0]), cross(v[0], v[1])};
        const double scale = 1.0 / (v[0].x * b[0].x + v[0].y * b[0].y + v[0].w * b[0].w);
        for (Homogeneous& row : b) row = {row.x * scale, row.y * scale, row.w * scale};
        for (int e = 0; e <= ctx.attribute_count; ++e) {
            double a[3] = {1.0, 1.0, 1.0};
            for (int i = 0; i < 3 && e > 0; ++i) {
                a[i] = static_cast<double>(
                    ctx.rows[static_cast<std::ptrdiff_t>(t.vertex[i]) * ctx.row_stride + e - 1]);
            }
            const auto sum = [&](double Homogeneous::*c) {
                return static_cast<float>(a[0] * (b[0].*c) + a[1] * (b[1].*c) + a[2] * (b[2].*c));
            };
            const bool edge_on = !std::isfinite(scale);
            float* const out =
                ctx.equations + static_cast<std::ptrdiff_t>(3 * e) * kAttributeStride + k;
            out[0] = edge_on ? static_cast<float>(a[0]) : sum(&Homogeneous::w);
            out[kAttributeStride] = edge_on ? 0.0F : sum(&Homogeneous::x);
            out[2 * kAttributeStride] = edge_on ? 0.0F : sum(&Homogeneous::y);
        }
    }
}

float* attribute(const Packet& packet, int k) {
    return packet.attributes + static_cast<std::ptrdiff_t>(k) * kAttributeStride;
}

std::int16_t* plane(const Packet& packet, int k) {
    return packet.planes + static_cast<std::ptrdiff_t>(k) * kPacketSize;
}

struct Equation {
    float origin, dx, dy;
};

Equation equation(const AttributesCtx& ctx, int e, int run) {
    const float* const row =
        ctx.equations + static_cast<std::ptrdiff_t>(3 * e) * kAttributeStride + run;
    return {row[0], row[kAttributeStride], row[2 * kAttributeStride]};
}

void attributes(Packet& packet, const AttributesCtx& ctx) noexcept {
    for (int r = 0; r < ctx.run_count; ++r) {
        const Run& run = ctx.runs[r];
        for (int i = run.first; i < run.first + run.count; ++i) {
            const auto x = static_cast<float>(tile_x(packet.pixels[i]) + run.offset_x);
            const auto y = static_cast<float>(tile_y(packet.pixels[i]) + run.offset_y);
            const auto value = [&](int e) {
                const Equation p = equation(ctx, e, r);
                return (p.origin + p.dx * x) + p.dy * y;
            };
            if (ctx.attribute_count == 0) continue;
            const float w = 1.0F / value(0);
            for (int k = 0; k < ctx.attribute_count; ++k)
                attribute(packet, k)[i] = value(k + 1) * w;
        }
    }
}

struct Vector {
    float x, y, z;
};

float dot(const Vector& a, const Vector& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vector normalised(const Vector& a) {
    const float scale = 1.0F / std::sqrt(dot(a, a));
    return {a.x * scale, a.y * scale, a.z * scale};
}

void lighting(Packet& packet, const LightingCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const auto read = [&](int k) -> Vector {
            return {attribute(packet, k)[i], attribute(packet, k + 1)[i],
                    attribute(packet, k + 2)[i]};
        };
        Vector tangent = read(ctx.frame);
        Vector bitangent = read(ctx.frame + 3);
        Vector normal = read(ctx.frame + 6);
        if (ctx.orthonormal != 0) {
            normal = normalised(normal);
            const float along = dot(normal, tangent);
            tangent = normalised({tangent.x - normal.x * along, tangent.y - normal.y * along,
                                  tangent.z - normal.z * along});
            const Vector c = cross(normal, tangent);
            const bool mirrored = dot(c, bitangent) < 0.0F;
            bitangent = mirrored ? Vector{-c.x, -c.y, -c.z} : c;
        }
        const Vector position = read(ctx.frame + 9);

        const bool is_direction = ctx.light_w == 0.0F;
        const Vector l = normalised(is_direction ? Vector{ctx.light[0], ctx.light[1], ctx.light[2]}
                                                 : Vector{ctx.light[0] - position.x * ctx.light_w,
                                                          ctx.light[1] - position.y * ctx.light_w,
                                                          ctx.light[2] - position.z * ctx.light_w});
        const Vector v =
            normalised({ctx.eye[0] - position.x * ctx.eye_w, ctx.eye[1] - position.y * ctx.eye_w,
                        ctx.eye[2] - position.z * ctx.eye_w});
        const Vector sum{l.x + v.x, l.y + v.y, l.z + v.z};
        const Vector h =
            ctx.raw_half != 0 ? Vector{sum.x * 0.5F, sum.y * 0.5F, sum.z * 0.5F} : normalised(sum);

        const auto write = [&](int k, const Vector& x) {
            if (k < 0) return;
            attribute(packet, k)[i] = dot(tangent, x) * 0.5F + 0.5F;
            attribute(packet, k + 1)[i] = dot(bitangent, x) * 0.5F + 0.5F;
            attribute(packet, k + 2)[i] = dot(normal, x) * 0.5F + 0.5F;
        };
        write(ctx.half_vector, h);
        write(ctx.light_vector, l);
        write(ctx.view_vector, v);
        if (ctx.n_dot_l >= 0) attribute(packet, ctx.n_dot_l)[i] = maximum(dot(normal, l), 0.0F);
        if (ctx.h_dot_l >= 0) attribute(packet, ctx.h_dot_l)[i] = maximum(dot(h, l), 0.0F);
    }
}

/// `x` of unit length, or as it is without length.
Vector unit_or_zero(const Vector& x) {
    const float length = std::sqrt(dot(x, x));
    if (!(length > 0.0F)) return x;
    const float scale = 1.0F / length;
    return {x.x * scale, x.y * scale, x.z * scale};
}

void light_vertices(const LightVerticesCtx& ctx) noexcept {
    for (int k = 0; k < ctx.count; ++k) {
        const float* f = ctx.frames + k * LightVerticesCtx::kFrameFloats;
        const Vector position{f[0], f[1], f[2]}, normal{f[3], f[4], f[5]};
        Vector n = normal, t{f[6], f[7], f[8]}, b = cross(n, t);
        b = {b.x * f[9], b.y * f[9], b.z * f[9]};
        if (ctx.orthonormal != 0) {
            n = unit_or_zero(n);
            const float along = dot(n, t);
            t = unit_or_zero({t.x - n.x * along, t.y - n.y * along, t.z - n.z * along});
            const Vector c = cross(n, t);
            b = dot(c, b) < 0.0F ? Vector{-c.x, -c.y, -c.z} : c;
        }
        const auto towards = [&](const float(&to)[3], float w) {
            return unit_or_zero(
                {to[0] - position.x * w, to[1] - position.y * w, to[2] - position.z * w});
        };
        const Vector l = towards(ctx.light, ctx.light_w), v = towards(ctx.eye, ctx.eye_w);
        const Vector sum{l.x + v.x, l.y + v.y, l.z + v.z};
        const Vector middle{sum.x * 0.5F, sum.y * 0.5F, sum.z * 0.5F};
        const Vector h = ctx.raw_half != 0 ? middle : unit_or_zero(sum);

        float values[VertexValue::count];
        const auto write_coded = [&](int first, const Vector& x) {
            values[first] = dot(t, x) * 0.5F + 0.5F;
            values[first + 1] = dot(b, x) * 0.5F + 0.5F;
            values[first + 2] = dot(n, x) * 0.5F + 0.5F;
        };
        write_coded(VertexValue::half, h);
        write_coded(VertexValue::light, l);
        write_coded(VertexValue::view, v);
        values[VertexValue::half_sum] = dot(t, middle);
        values[VertexValue::half_sum + 1] = dot(b, middle);
        values[VertexValue::half_sum + 2] = dot(n, middle);
        const float n_dot_l = maximum(dot(n, l), 0.0F);
        values[VertexValue::n_dot_l] = n_dot_l;
        values[VertexValue::h_dot_l] = maximum(dot(h, l), 0.0F);
        for (int c = 0; c < 3; ++c)
            values[VertexValue::lit + c] = n_dot_l * ctx.tint[c] + ctx.base[c];
        values[VertexValue::normal] = normal.x * 0.5F + 0.5F;
        values[VertexValue::normal + 1] = normal.y * 0.5F + 0.5F;
        values[VertexValue::normal + 2] = normal.z * 0.5F + 0.5F;
        values[VertexValue::uv] = f[10];
        values[VertexValue::uv + 1] = 1.0F - f[11];
        const Vector tangent{f[6], f[7], f[8]}, side = cross(normal, tangent);
        const Vector frame[4] = {
            tangent, {side.x * f[9], side.y * f[9], side.z * f[9]}, normal, position};
        for (int c = 0; c < 4; ++c) {
            values[VertexValue::frame + 3 * c] = frame[c].x;
            values[VertexValue::frame + 3 * c + 1] = frame[c].y;
            values[VertexValue::frame + 3 * c + 2] = frame[c].z;
        }
        for (int i = 0; i < ctx.stride; ++i)
            if (ctx.values[i] != VertexValue::none)
                ctx.out[k * ctx.stride + i] = values[ctx.values[i]];
    }
}

// ---- texels

struct TexelPosition {
    std::int32_t texel;  ///< upper or left
    std::int16_t weight;
};

/// `linear`: between two texels, else the nearest. Coordinates run over 0 .. 1, of a rectangle over
/// 0 .. size.
TexelPosition texel_position(float u, std::int32_t size, AddressMode mode, bool linear,
                             bool rectangle) {
    const float whole = rectangle ? static_cast<float>(size) : 1.0F;
    const float steps = rectangle ? 256.0F : static_cast<float>(256 * size);
    const bool border = mode == AddressMode::clamp_to_border;
    float f = u;
    if (mode == AddressMode::repeat) f = u - std::floor(u);
    if (mode == AddressMode::mirrored_repeat) {
        f = u - 2.0F * std::floor(u * 0.5F);
        if (f > 1.0F) f = 2.0F - f;
    }
    f = minimum(maximum(f, border ? -1.0F : 0.0F), border ? whole + 1.0F : whole);
    const auto fixed = static_cast<std::int32_t>(std::floor(f * steps)) - (linear ? 128 : 0);
    TexelPosition p{fixed >> 8, static_cast<std::int16_t>(linear ? fixed & 255 : 0)};
    const auto stop_at = [&](std::int32_t texel) { p = {texel, 0}; };
    switch (mode) {
        case AddressMode::repeat:
            if (p.texel < 0) p.texel += size;
            if (p.texel >= size) p.texel -= size;
            break;
        case AddressMode::clamp_to_border:
            if (p.texel < -1) stop_at(-1);
            if (p.texel >= size) stop_at(size);
            break;
        case AddressMode::clamp_to_edge:
        case AddressMode::mirrored_repeat:
            if (p.texel < 0) stop_at(0);
            if (p.texel >= size) p.texel = size - 1;
            break;
    }
    return p;
}

void address(Packet& packet, const AddressCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        float u = attribute(packet, ctx.u)[i];
        float v = attribute(packet, ctx.v)[i];
        if (ctx.q >= 0) {
            u = u / attribute(packet, ctx.q)[i];
            v = v / attribute(packet, ctx.q)[i];
        }
        const bool linear = ctx.linear != 0, rectangle = ctx.rectangle != 0;
        const TexelPosition s = texel_position(u, ctx.width, ctx.mode_s, linear, rectangle);
        const TexelPosition t = texel_position(v, ctx.height, ctx.mode_t, linear, rectangle);
        packet.texel[i] = t.texel * ctx.pitch + s.texel * (1 << ctx.texel_shift);
        packet.weight_x[i] = s.weight;
        packet.weight_y[i] = t.weight;
    }
}

/// Something at a pixel, and how it changes to the right and downwards.
struct Changing {
    float value, dx, dy;
    Changing operator-() const { return {-value, -dx, -dy}; }
};

/// Where a direction meets a cube map, before the division by m.
struct FacePoint {
    int face;
    Changing a, b, m;
};

FacePoint face_point(const Changing& s, const Changing& t, const Changing& r) {
    const float x = std::fabs(s.value), y = std::fabs(t.value), z = std::fabs(r.value);
    if (x >= y && x >= z) {
        if (s.value < 0.0F) return {1, r, -t, -s};
        return {0, -r, -t, s};
    }
    if (y >= z) {
        if (t.value < 0.0F) return {3, s, -r, -t};
        return {2, s, r, t};
    }
    if (r.value < 0.0F) return {5, -s, -t, -r};
    return {4, s, -t, r};
}

void cube_face(Packet& packet, const CubeFaceCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const auto direction = [&](int k) -> Changing { return {attribute(packet, k)[i], 0, 0}; };
        const FacePoint p = face_point(direction(ctx.s), direction(ctx.t), direction(ctx.r));
        attribute(packet, ctx.u)[i] = (p.a.value / p.m.value) * 0.5F + 0.5F;
        attribute(packet, ctx.v)[i] = (p.b.value / p.m.value) * 0.5F + 0.5F;
        plane(packet, ctx.face)[i] = static_cast<std::int16_t>(p.face);
    }
}

/// How far the coordinate c / d moves along an axis of the screen.
float moved(const Changing& c, const Changing& d, float Changing::*along) {
    const float u = c.value / d.value;
    return (c.*along - u * (d.*along)) / d.value;
}

/// `at` gives attribute k, or with -1 the divisor where there is no q.
template <class At>
float footprint(const FootprintCtx& ctx, At at) {
    Changing s = at(ctx.s), t = at(ctx.t), r{0.0F, 0.0F, 0.0F}, d{};
    if (ctx.cube != 0) {
        const FacePoint p = face_point(s, t, at(ctx.r));
        s = p.a;
        t = p.b;
        d = p.m;
    } else {
        if (ctx.r >= 0) r = at(ctx.r);
        d = at(ctx.q);
    }
    const auto square = [&](float Changing::*along) {
        const auto texels = [&](const Changing& c, float scale) {
            return moved(c, d, along) * scale;
        };
        const float x = texels(s, ctx.scale[0]), y = texels(t, ctx.scale[1]);
        const float flat = x * x + y * y;
        if (ctx.cube != 0 || ctx.r < 0) return flat;
        const float z = texels(r, ctx.scale[2]);
        return flat + z * z;
    };
    return maximum(square(&Changing::dx), square(&Changing::dy));
}

/// Calls f(i, at) for every fragment i; at(k) is attribute k over w there, at(-1) 1/w.
template <class F>
void for_each_fragment(const Packet& packet, const AttributesCtx& runs, F f) {
    for (int k = 0; k < runs.run_count; ++k) {
        const Run& run = runs.runs[k];
        for (int i = run.first; i < run.first + run.count; ++i) {
            const auto x = static_cast<float>(tile_x(packet.pixels[i]) + run.offset_x);
            const auto y = static_cast<float>(tile_y(packet.pixels[i]) + run.offset_y);
            f(i, [&](int attribute) -> Changing {
                const Equation p = equation(runs, attribute + 1, k);
                return {(p.origin + p.dx * x) + p.dy * y, p.dx, p.dy};
            });
        }
    }
}

void plane_footprint(Packet& packet, const PlaneFootprintCtx& ctx) noexcept {
    for_each_fragment(packet, ctx.runs, [&](int i, auto at) {
        attribute(packet, ctx.footprint.out)[i] = footprint(ctx.footprint, at);
    });
}

void quad_footprint(Packet& packet, const QuadFootprintCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int left = i & ~1, upper = i & ~2;
        const auto at = [&](int k) -> Changing {
            if (k < 0) return {1.0F, 0.0F, 0.0F};
            const float* a = attribute(packet, k);
            return {a[i], a[left + 1] - a[left], a[upper + 2] - a[upper]};
        };
        attribute(packet, ctx.footprint.out)[i] = footprint(ctx.footprint, at);
    }
}

void probe_extent(Packet& packet, const ProbeExtentCtx& ctx) noexcept {
    for_each_fragment(packet, ctx.runs, [&](int i, auto at) {
        const FootprintCtx& how = ctx.footprint;
        const Changing s = at(how.s), t = at(how.t), d = at(how.q);
        struct Step {
            float u, v, square;
        };
        const auto step = [&](float Changing::*along) -> Step {
            const float u = moved(s, d, along), v = moved(t, d, along);
            const float x = u * how.scale[0], y = v * how.scale[1];
            return {u, v, x * x + y * y};
        };
        const Step x = step(&Changing::dx), y = step(&Changing::dy);
        const float longest = maximum(x.square, y.square);
        const float shortest = maximum(minimum(x.square, y.square), 1.0F);
        const float n =
            minimum(maximum(std::ceil(std::sqrt(longest / shortest) - 0x1p-8F), 1.0F), ctx.most);
        const Step& longer = x.square > y.square ? x : y;
        attribute(packet, how.out)[i] = longest / (n * n);
        attribute(packet, ctx.probes)[i] = n;
        attribute(packet, ctx.step)[i] = n > 1.0F ? longer.u / (n + 1.0F) : 0.0F;
        attribute(packet, ctx.step + 1)[i] = n > 1.0F ? longer.v / (n + 1.0F) : 0.0F;
    });
}

void probe_point(Packet& packet, const ProbePointCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int n = static_cast<int>(attribute(packet, ctx.probes)[i]);
        const float steps =
            static_cast<float>(std::min(ctx.probe, n - 1)) - static_cast<float>(n - 1) * 0.5F;
        for (int c = 0; c < 2; ++c) {
            float at = attribute(packet, c == 0 ? ctx.u : ctx.v)[i];
            if (ctx.q >= 0) at = at / attribute(packet, ctx.q)[i];
            attribute(packet, ctx.to + c)[i] = at + attribute(packet, ctx.step + c)[i] * steps;
        }
    }
}

void probe_sum(Packet& packet, const ProbeSumCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int n = static_cast<int>(attribute(packet, ctx.probes)[i]);
        for (int c = 0; c < ctx.channels; ++c) {
            float& sum = attribute(packet, ctx.sum + c)[i];
            const Int before = ctx.probe == 0 ? 0 : static_cast<Int>(sum);
            const Int code = ctx.probe < n ? plane(packet, ctx.plane[c])[i] : 0;
            sum = static_cast<float>(before + code);
        }
    }
}

void probe_mean(Packet& packet, const ProbeSumCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Int n = static_cast<Int>(attribute(packet, ctx.probes)[i]);
        for (int c = 0; c < ctx.channels; ++c) {
            const Int unit = (ctx.doubled >> c & 1) != 0 ? 2 : 1;
            const Int sum = static_cast<Int>(attribute(packet, ctx.sum + c)[i]) / unit;
            // floor((2 sum + n) / (2 n)), the numerator made positive by a multiple of 2 n.
            const Int mean = (2 * sum + n + (Int{2} * n << 24)) / (2 * n) - (Int{1} << 24);
            plane(packet, ctx.plane[c])[i] = static_cast<std::int16_t>(mean * unit);
        }
    }
}

void level_of_detail(Packet& packet, const LevelOfDetailCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const float f = minimum(maximum(attribute(packet, ctx.footprint)[i], 0x1p-64F), 0x1p64F);
        std::int32_t bits;
        std::memcpy(&bits, &f, sizeof bits);
        Int lambda = Int{128} * ((bits >> 23) - 127) + ctx.bias;
        for (const std::int32_t step : kLog2Step) lambda += step <= (bits & 0x7fffff) ? 1 : 0;
        plane(packet, ctx.plane)[i] = static_cast<std::int16_t>(clamp(lambda, 0, ctx.max));
    }
}

int chosen_level(LevelChoice choice, int lambda, int last) {
    switch (choice) {
        case LevelChoice::base:
            return 0;
        case LevelChoice::nearest:
            return std::min((lambda + 127) >> 8, last);
        case LevelChoice::floor:
            return lambda >> 8;
        case LevelChoice::ceiling:
            return std::min((lambda >> 8) + 1, last);
    }
    return 0;
}

std::int32_t slice_behind(std::int32_t slice, std::int32_t depth, AddressMode mode) {
    const std::int32_t next = slice + 1;
    if (mode == AddressMode::clamp_to_border) return std::min(next, depth);
    if (next < depth) return next;
    return mode == AddressMode::repeat ? 0 : depth - 1;
}

void level_address(Packet& packet, const LevelAddressCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int lambda = ctx.lambda < 0 ? 0 : plane(packet, ctx.lambda)[i];
        const bool linear = (lambda > 0 ? ctx.min_linear : ctx.mag_linear) != 0;
        const LevelAddressCtx::Level& level =
            ctx.levels[chosen_level(ctx.choice, lambda, ctx.level_count - 1)];
        const auto coordinate = [&](int k) {
            const float c = attribute(packet, k)[i];
            return ctx.q < 0 ? c : c / attribute(packet, ctx.q)[i];
        };
        const bool rectangle = ctx.rectangle != 0;
        const TexelPosition s =
            texel_position(coordinate(ctx.u), level.width, ctx.mode_s, linear, rectangle);
        const TexelPosition t =
            texel_position(coordinate(ctx.v), level.height, ctx.mode_t, linear, rectangle);
        std::int32_t layer = ctx.face < 0 ? 0 : plane(packet, ctx.face)[i];
        if (ctx.r >= 0) {
            const TexelPosition r =
                texel_position(coordinate(ctx.r), level.depth, ctx.mode_r, linear, false);
            layer = ctx.behind != 0 ? slice_behind(r.texel, level.depth, ctx.mode_r) : r.texel;
            if (ctx.slice_weight >= 0) plane(packet, ctx.slice_weight)[i] = r.weight;
        }
        packet.texel[i] = level.offset + t.texel * ctx.pitch + s.texel * ctx.texel_bytes +
                          layer * ctx.layer_bytes;
        packet.weight_x[i] = s.weight;
        packet.weight_y[i] = t.weight;
    }
}

struct CornerPosition {
    float coordinate;
    std::int16_t weight;
};

CornerPosition corner_position(float u, std::int32_t size, AddressMode mode, bool linear,
                               bool rectangle, bool second) {
    const float steps = rectangle ? 256.0F : static_cast<float>(256 * size);
    float whole = 0.0F;
    if (mode == AddressMode::repeat) whole = std::floor(u);
    if (mode == AddressMode::mirrored_repeat) whole = 2.0F * std::floor(u * 0.5F);
    const float f = u - whole;
    const bool mirrored = mode == AddressMode::mirrored_repeat && f > 1.0F;
    const float x = std::floor((mirrored ? 2.0F - f : f) * steps) - (linear ? 128.0F : 0.0F);
    const float x0 = std::floor(x * 0x1p-8F);
    const float weight = minimum(maximum(x - x0 * 256.0F, 0.0F), 255.0F);
    const float c = (x0 * 256.0F + (second ? 384.5F : 128.5F)) / steps;
    return {whole + (mirrored ? 2.0F - c : c),
            linear ? static_cast<std::int16_t>(weight) : std::int16_t{0}};
}

void texel_corner(Packet& packet, const TexelCornerCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int lambda = ctx.lambda < 0 ? 0 : plane(packet, ctx.lambda)[i];
        const bool linear = (lambda > 0 ? ctx.min_linear : ctx.mag_linear) != 0;
        const int number = chosen_level(ctx.choice, lambda, ctx.level_count - 1);
        const LevelAddressCtx::Level& level = ctx.levels[number];
        const auto coordinate = [&](int k) {
            const float c = attribute(packet, k)[i];
            return ctx.q < 0 ? c : c / attribute(packet, ctx.q)[i];
        };
        const bool rectangle = ctx.rectangle != 0;
        const CornerPosition s = corner_position(coordinate(ctx.u), level.width, ctx.mode_s, linear,
                                                 rectangle, ctx.right != 0);
        const CornerPosition t = corner_position(coordinate(ctx.v), level.height, ctx.mode_t,
                                                 linear, rectangle, ctx.below != 0);
        attribute(packet, ctx.to)[i] = s.coordinate;
        attribute(packet, ctx.to + 1)[i] = t.coordinate;
        plane(packet, ctx.weight)[i] = s.weight;
        plane(packet, ctx.weight + 1)[i] = t.weight;
        if (ctx.level >= 0) plane(packet, ctx.level)[i] = static_cast<std::int16_t>(256 * number);
    }
}

// ---- the two number models

/// x / 2 with ties to the even neighbour.
Int halve_to_even(Int x) {
    const Int low = x >> 1;
    return (x & 1) != 0 && (low & 1) != 0 ? low + 1 : low;
}

Int mapped(std::uint8_t mapping, Int e, Int one, Int half) {
    const Int positive = std::max<Int>(0, e);
    switch (mapping) {
        case 0:
            return positive;
        case 1:
            return one - std::min(positive, one);
        case 2:
            return 2 * (positive - half);
        case 3:
            return -2 * (positive - half);
        case 4:
            return positive - half;
        case 5:
            return half - positive;
        case 6:
            return e;
        case 7:
            return -e;
        case Operand::kIdealHalf + 2:
            return 2 * positive - one;
        case Operand::kIdealHalf + 3:
            return one - 2 * positive;
        case Operand::kIdealHalf + 4:
            return halve_to_even(2 * positive - one);
        default:
            return halve_to_even(one - 2 * positive);
    }
}

struct NineBit {
    static constexpr Int kOne = 255;
    static constexpr Int kHalf = 128;
    static constexpr Int kLow = -256;
    static constexpr float kDimRound = 0.02F;

    static Int map(std::uint8_t mapping, Int e) { return mapped(mapping, e, kOne, kHalf); }
    static Int quotient(Int x, Rounding rounding) {
        switch (rounding) {
            case Rounding::nearest:
                return divide_to_nearest(x, kOne);
            case Rounding::truncate:
                return x / kOne;
            case Rounding::shift8:
                return x >> 8;
        }
        return 0;
    }
    static Int clamp_output(Int x, bool /*wide*/) { return clamp(x, -kOne, kOne); }
    static Int final_identity(Int e) { return std::max<Int>(0, e); }
    static Int color_sum(Int a, Int b) { return a + b; }

    static Int filter(Int top_left, Int top_right, Int bottom_left, Int bottom_right, Int wx,
                      Int wy) {
        const Int top = shift_half_up((256 - wx) * top_left + wx * top_right, 8);
        const Int bottom = shift_half_up((256 - wx) * bottom_left + wx * bottom_right, 8);
        return shift_half_up((256 - wy) * top + wy * bottom, 8);
    }
    static Int texel_code(Int v, bool is_signed) { return is_signed ? 2 * (v - 128) : v; }
    static Int to_8_bits(Int v) { return v; }
    static Int to_16_bits(Int v) { return 257 * v; }
};

struct Wide {
    static constexpr Int kOne = 16384;
    static constexpr Int kHalf = 8192;
    static constexpr Int kLow = -32768;
    static constexpr Int kHigh = 32767;
    static constexpr float kDimRound = 0.5F;

    static Int map(std::uint8_t mapping, Int e) {
        return clamp(mapped(mapping, e, kOne, kHalf), kLow, kHigh);
    }
    static Int quotient(Int x, Rounding /*nearest*/) { return shift_half_up(x, 14); }
    static Int clamp_output(Int x, bool wide) {
        return wide ? clamp(x, kLow, kHigh) : clamp(x, -kOne, kOne);
    }
    static Int final_identity(Int e) { return clamp(e, 0, kOne); }
    static Int color_sum(Int a, Int b) { return std::min(a + b, kHigh); }

    static Int filter(Int top_left, Int top_right, Int bottom_left, Int bottom_right, Int wx,
                      Int wy) {
        const Int top = (256 - wx) * top_left + wx * top_right;
        const Int bottom = (256 - wx) * bottom_left + wx * bottom_right;
        return shift_half_up((256 - wy) * top + wy * bottom, 8);
    }
    static Int texel_code(Int v, bool is_signed) {
        return is_signed ? shift_half_up(v - 32768, 1) : (v + (v >> 8) + 2) >> 2;
    }
    static Int to_8_bits(Int v) { return shift_half_up(255 * v, 14); }
    static Int to_16_bits(Int v) { return shift_half_up(65535 * v, 14); }
};

template <class Model>
void encode(Packet& packet, const EncodeCtx& ctx) noexcept {
    constexpr auto one = static_cast<float>(Model::kOne);
    for (int i = 0; i < packet.count; ++i) {
        const float x = attribute(packet, ctx.attribute)[i] * one + 0.5F;
        plane(packet, ctx.plane)[i] = static_cast<std::int16_t>(minimum(maximum(x, 0.0F), one));
    }
}

template <class Model>
void fetch(Packet& packet, const FetchCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        for (int k = 0; k < 4 * ctx.count; ++k) {
            const int c = k % 4;
            const auto texel = [&](std::int32_t offset) {
                const auto byte = static_cast<std::int8_t>(ctx.texels[k / 4][offset + c]);
                return Int{127} - Int{byte};
            };
            const std::int32_t upper = packet.texel[i], lower = upper + ctx.pitch;
            const Int value =
                Model::filter(texel(upper), texel(upper + 4), texel(lower), texel(lower + 4),
                              packet.weight_x[i], packet.weight_y[i]);
            plane(packet, ctx.plane[k / 4] + c)[i] = static_cast<std::int16_t>(
                Model::texel_code(value, (ctx.is_signed[k / 4] >> c & 1) != 0));
        }
    }
}

Int word_at(const std::uint8_t* texels, std::ptrdiff_t offset) {
    std::int16_t word;
    std::memcpy(&word, texels + offset, sizeof word);
    return word;
}

void fetch_hilo(Packet& packet, const FetchHiloCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Int wx = packet.weight_x[i], wy = packet.weight_y[i];
        for (int c = 0; c < 2; ++c) {
            const auto row = [&](std::ptrdiff_t left) {
                const Int l = word_at(ctx.texels, left + 2 * c);
                const Int r = word_at(ctx.texels, left + 4 + 2 * c);
                return shift_half_up((256 - wx) * l + wx * r, 8);
            };
            const Int top = row(packet.texel[i]), bottom = row(packet.texel[i] + ctx.pitch);
            plane(packet, ctx.plane + c)[i] =
                static_cast<std::int16_t>(shift_half_up((256 - wy) * top + wy * bottom, 8));
        }
    }
}

void fetch_words(Packet& packet, const FetchWordsCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Int wx = packet.weight_x[i], wy = packet.weight_y[i];
        for (int c = 0; c < 4; ++c) {
            const auto row = [&](std::ptrdiff_t left) {
                return (256 - wx) * word_at(ctx.texels, left + 2 * c) +
                       wx * word_at(ctx.texels, left + 8 + 2 * c);
            };
            const Int top = row(packet.texel[i]), bottom = row(packet.texel[i] + ctx.pitch);
            const Int x = shift_half_up((256 - wy) * top + wy * bottom, 16);
            plane(packet, ctx.plane + c)[i] = static_cast<std::int16_t>((x + 32768 + 2) >> 2);
        }
    }
}

void prefetch_quartet(Packet& /*packet*/, const PrefetchQuartetCtx& /*ctx*/) noexcept {}

void fetch_quartet(Packet& packet, const FetchQuartetCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Int wx = packet.weight_x[i], wy = packet.weight_y[i];
        for (int k = 0; k < FetchQuartetCtx::kTextures; ++k) {
            for (int c = 0; c < 4 && ctx.plane[k] >= 0; ++c) {
                if ((ctx.channels[k] >> c & 1) == 0) continue;
                const auto row = [&](std::ptrdiff_t left) {
                    const std::ptrdiff_t channel = left + FetchQuartetCtx::kNextTexture * k + 2 * c;
                    return (256 - wx) * word_at(ctx.texels, channel) +
                           wx * word_at(ctx.texels, channel + FetchQuartetCtx::kTexelBytes);
                };
                const Int top = row(packet.texel[i]), bottom = row(packet.texel[i] + ctx.pitch);
                const Int x = shift_half_up((256 - wy) * top + wy * bottom, 16);
                plane(packet, ctx.plane[k] + c)[i] =
                    static_cast<std::int16_t>((x + 32768 + 2) >> 2);
            }
        }
    }
}

void look_up_table(Packet& packet, const LookUpTableCtx& ctx) noexcept {
    constexpr int kRight = 4, kBelow = 2;  // bytes
    for (int i = 0; i < packet.count; ++i) {
        const auto position = [&](const LookUpTableCtx::Axis& axis) {
            if (axis.plane < 0) return TexelPosition{0, 0};
            const float number = static_cast<float>(plane(packet, axis.plane)[i]) / 16384.0F;
            return texel_position((number * axis.scale + axis.offset) / axis.divisor, axis.size,
                                  AddressMode::clamp_to_edge, true, false);
        };
        const TexelPosition s = position(ctx.s), t = position(ctx.t);
        const auto row = [&](std::ptrdiff_t left) {
            return (256 - Int{s.weight}) * word_at(ctx.texels, left) +
                   Int{s.weight} * word_at(ctx.texels, left + kRight);
        };
        const std::ptrdiff_t left = std::ptrdiff_t{t.texel} * ctx.pitch + kRight * s.texel;
        const Int x = shift_half_up(
            (256 - Int{t.weight}) * row(left) + Int{t.weight} * row(left + kBelow), 16);
        for (const int out : ctx.out)
            if (out >= 0) plane(packet, out)[i] = static_cast<std::int16_t>((x + 32768 + 2) >> 2);
    }
}

/// One end of what a summed table is averaged over.
struct SumEnd {
    Int place;            ///< p
    std::int32_t sum[2];  ///< of the row and the one below
    float rest[2];        ///< r
};

SumEnd sum_end(const AverageTableCtx& ctx, float coordinate, std::ptrdiff_t row) {
    const float at = (coordinate * ctx.s.scale + ctx.s.offset) / ctx.s.divisor;
    const auto place =
        static_cast<Int>(std::floor(at * static_cast<float>(256 * ctx.s.size))) - 128;
    const Int inside = clamp(place, 0, 256 * (Int{ctx.s.size} - 1));
    const Int weight = inside & 255;
    SumEnd end{place, {}, {}};
    for (int k = 0; k < (ctx.t.plane < 0 ? 1 : 2); ++k) {
        const std::ptrdiff_t texel = row + k * std::ptrdiff_t{ctx.pitch} + 8 * (inside >> 8);
        const Int own = word_at(ctx.texels, texel), next = word_at(ctx.texels, texel + 2);
        std::memcpy(&end.sum[k], ctx.texels + texel + 4, sizeof end.sum[k]);
        const float within =
            static_cast<float>(weight) * static_cast<float>(512 * own + weight * (next - own));
        end.rest[k] = within * 0x1p-16F +
                      static_cast<float>(place - inside) * static_cast<float>(own) * 0x1p-7F;
    }
    return end;
}

/// What LookUpTableCtx makes of a summed table.
Int summed_word(const AverageTableCtx& ctx, TexelPosition s, TexelPosition t) {
    const auto row = [&](int k) {
        const std::ptrdiff_t texel = (t.texel + k) * std::ptrdiff_t{ctx.pitch} + 8 * s.texel;
        return (256 - Int{s.weight}) * word_at(ctx.texels, texel) +
               Int{s.weight} * word_at(ctx.texels, texel + 2);
    };
    const Int below = ctx.t.plane < 0 ? 0 : row(1);
    return shift_half_up((256 - Int{t.weight}) * row(0) + Int{t.weight} * below, 16);
}

void average_table(Packet& packet, const AverageTableCtx& ctx) noexcept {
    const std::int16_t* const codes = plane(packet, ctx.s.plane);
    const auto number = [&](int k, int i) {
        return static_cast<float>(plane(packet, k)[i]) / 16384.0F;
    };
    std::int16_t result[kPacketSize];
    for (int i = 0; i < packet.count; ++i) {
        const int left = i & ~1, upper = i & ~2;
        const int step = std::max(std::abs(codes[left + 1] - codes[left]),
                                  std::abs(codes[upper + 2] - codes[upper]));
        const float at = number(ctx.s.plane, i), half = static_cast<float>(step) * ctx.reach;
        TexelPosition row{0, 0};
        if (ctx.t.plane >= 0) {
            const float below = number(ctx.t.plane, i) * ctx.t.scale + ctx.t.offset;
            row = texel_position(below / ctx.t.divisor, ctx.t.size, AddressMode::clamp_to_edge,
                                 true, false);
        }
        const std::ptrdiff_t first = std::ptrdiff_t{row.texel} * ctx.pitch;
        const SumEnd low = sum_end(ctx, maximum(at - half, ctx.least), first),
                     high = sum_end(ctx, minimum(at + half, ctx.most), first);
        Int x = 0;
        if (high.place > low.place) {
            const auto area = [&](int k) {
                return static_cast<float>(high.sum[k] - low.sum[k]) + (high.rest[k] - low.rest[k]);
            };
            float n = area(0);
            if (ctx.t.plane >= 0)
                n = n + (area(1) - n) * (static_cast<float>(row.weight) * 0x1p-8F);
            const float mean = n * 128.0F / static_cast<float>(high.place - low.place);
            x = clamp(static_cast<Int>(std::floor(mean + 0.5F)), -32768, 32767);
        } else {
            const float place = (at * ctx.s.scale + ctx.s.offset) / ctx.s.divisor;
            x = summed_word(
                ctx, texel_position(place, ctx.s.size, AddressMode::clamp_to_edge, true, false),
                row);
        }
        result[i] = static_cast<std::int16_t>((x + 32768 + 2) >> 2);
    }
    for (const int out : ctx.out)
        if (out >= 0) std::copy_n(result, packet.count, plane(packet, out));
}

void blend_levels(Packet& packet, const BlendLevelsCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Int w = plane(packet, ctx.weight)[i] & 255;
        for (int c = 0; c < ctx.channels; ++c) {
            const Int a = plane(packet, ctx.a + c)[i], b = plane(packet, ctx.b + c)[i];
            const Int unit = (ctx.doubled >> c & 1) != 0 ? 2 : 1;
            const Int n = shift_half_up((256 - w) * (a / unit) + w * (b / unit), 8);
            plane(packet, ctx.out + c)[i] = static_cast<std::int16_t>(n * unit);
        }
    }
}

void hilo(Packet& packet, const HiloCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        for (int c = 0; c < 2; ++c) {
            const int x = plane(packet, ctx.plane + c)[i];
            attribute(packet, ctx.out + c)[i] = ctx.is_signed != 0
                                                    ? static_cast<float>(x) / 32768.0F
                                                    : static_cast<float>(x + 32768) / 65535.0F;
        }
    }
}

// ---- from a texel to the next coordinates

/// The low byte of a code in two's complement.
int two_complement(int code) {
    return code >= 128 ? code - 256 : code;
}

float number_nine_bit(Reading reading, int code) {
    const int n = two_complement(code);
    switch (reading) {
        case Reading::unsigned_texel:
            return static_cast<float>(code) / 255.0F;
        case Reading::signed_texel:
            return static_cast<float>(code) / 256.0F;
        case Reading::expanded:
            return (static_cast<float>(std::max(code, 0)) - 127.5F) / 127.5F;
        case Reading::two_complement:
            return static_cast<float>(n) / 128.0F;
        case Reading::nv2a_d3d:
            return (static_cast<float>(code) - 128.0F) / 127.0F;
        case Reading::nv2a_gl:
            return (static_cast<float>(n) + 0.5F) / 127.5F;
        case Reading::nv2a_signed:
            return static_cast<float>(n) / 127.0F;
    }
    return 0.0F;
}

float number_wide(Reading reading, int code) {
    if (reading == Reading::expanded)
        return (static_cast<float>(std::max(code, 0)) - 8192.0F) / 8192.0F;
    return static_cast<float>(code) / 16384.0F;
}

template <float (*Number)(Reading, int)>
void decode(Packet& packet, const DecodeCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i)
        attribute(packet, ctx.attribute)[i] = Number(ctx.reading, plane(packet, ctx.plane)[i]);
}

void affine(Packet& packet, const AffineCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const float x = attribute(packet, ctx.from)[i];
        attribute(packet, ctx.to)[i] = (x * ctx.scale + ctx.offset) / ctx.divisor;
    }
}

Vector vector_of(const Packet& packet, const int (&planes)[3], int i) {
    return {attribute(packet, planes[0])[i], attribute(packet, planes[1])[i],
            attribute(packet, planes[2])[i]};
}

void dot_product(Packet& packet, const DotCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i)
        attribute(packet, ctx.to)[i] =
            dot(vector_of(packet, ctx.a, i), vector_of(packet, ctx.b, i));
}

void hemisphere(Packet& packet, const HemisphereCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const float x = attribute(packet, ctx.x)[i], y = attribute(packet, ctx.y)[i];
        attribute(packet, ctx.to)[i] = std::sqrt(maximum((1.0F - x * x) - y * y, 0.0F));
    }
}

void offset(Packet& packet, const OffsetCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        float s = attribute(packet, ctx.s)[i], t = attribute(packet, ctx.t)[i];
        if (ctx.q >= 0) {
            s = s / attribute(packet, ctx.q)[i];
            t = t / attribute(packet, ctx.q)[i];
        }
        const float ds = attribute(packet, ctx.ds)[i], dt = attribute(packet, ctx.dt)[i];
        attribute(packet, ctx.to)[i] = (s + ctx.m[0] * ds) + ctx.m[2] * dt;
        attribute(packet, ctx.to + 1)[i] = (t + ctx.m[1] * ds) + ctx.m[3] * dt;
    }
}

void reflect(Packet& packet, const ReflectCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const Vector n = vector_of(packet, ctx.n, i), e = vector_of(packet, ctx.e, i);
        const float k = (2.0F * dot(n, e)) / dot(n, n);
        attribute(packet, ctx.to)[i] = k * n.x - e.x;
        attribute(packet, ctx.to + 1)[i] = k * n.y - e.y;
        attribute(packet, ctx.to + 2)[i] = k * n.z - e.z;
    }
}

void quotient(Packet& packet, const QuotientCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i)
        attribute(packet, ctx.to)[i] = attribute(packet, ctx.a)[i] / attribute(packet, ctx.b)[i];
}

void angle(Packet& packet, const AngleCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const float d = attribute(packet, ctx.a)[i] - attribute(packet, ctx.b)[i];
        attribute(packet, ctx.to)[i] = d - std::floor(d);
    }
}

void cull(Packet& packet, const CullCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        bool kept = ctx.also < 0 || attribute(packet, ctx.also)[i] > 0.0F;
        for (int k = 0; k < 4; ++k) {
            const float x = attribute(packet, ctx.coordinate[k])[i];
            kept = kept && (ctx.less[k] != 0 ? x < 0.0F : x >= 0.0F);
        }
        attribute(packet, ctx.keep)[i] = kept ? 1.0F : 0.0F;
    }
}

template <class Model>
void dim(Packet& packet, const MagnitudeCtx& ctx) noexcept {
    constexpr auto one = static_cast<float>(Model::kOne);
    for (int i = 0; i < packet.count; ++i) {
        float f =
            ctx.bias + ctx.scale * (static_cast<float>(plane(packet, ctx.magnitude)[i]) / one);
        if (ctx.clamp_factor != 0) f = minimum(maximum(f, 0.0F), 1.0F);
        for (int c = 0; c < 3; ++c) {
            const auto code = static_cast<float>(plane(packet, ctx.from + c)[i]);
            const float x =
                minimum(maximum(code * f + Model::kDimRound, static_cast<float>(Model::kLow)), one);
            plane(packet, ctx.to + c)[i] = static_cast<std::int16_t>(std::floor(x));
        }
        plane(packet, ctx.to + 3)[i] = plane(packet, ctx.from + 3)[i];
    }
}

// ---- general combiners

template <class Model>
Int input(const Packet& packet, const Operand& operand, int component, int i) {
    return Model::map(operand.mapping, plane(packet, operand.plane[component])[i]);
}

template <class Model>
Int product(const Packet& packet, ProductKind kind, const Operand& x, const Operand& y,
            Rounding rounding, int component, int i) {
    const auto term = [&](int c) {
        return Model::quotient(input<Model>(packet, x, c, i) * input<Model>(packet, y, c, i),
                               rounding);
    };
    switch (kind) {
        case ProductKind::multiply:
            return term(component);
        case ProductKind::dot:
            return term(0) + term(1) + term(2);
        case ProductKind::none:
            return 0;
    }
    return 0;
}

template <class Model>
std::int16_t output(const PortionCtx& ctx, Int x) {
    if (ctx.bias_minus_half != 0) x -= Model::kHalf;
    switch (ctx.scale) {
        case OutputScale::one:
            break;
        case OutputScale::two:
            x *= 2;
            break;
        case OutputScale::four:
            x *= 4;
            break;
        case OutputScale::half:
            x = ctx.halve_down != 0 ? x >> 1 : shift_half_up(x, 1);
            break;
    }
    return static_cast<std::int16_t>(Model::clamp_output(x, ctx.wide != 0));
}

template <class Model>
void portion(Packet& packet, const PortionCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const std::int16_t selector = plane(packet, ctx.mux_plane)[i];
        const bool takes_cd = ctx.mux_lsb != 0 ? (selector & 1) != 0 : selector >= Model::kHalf;
        Int ab[3], cd[3];
        for (int c = 0; c < ctx.components; ++c) {
            ab[c] = product<Model>(packet, ctx.ab, ctx.a, ctx.b, ctx.rounding, c, i);
            cd[c] = product<Model>(packet, ctx.cd, ctx.c, ctx.d, ctx.rounding, c, i);
        }
        for (int c = 0; c < ctx.components; ++c) {
            plane(packet, ctx.ab_out[c])[i] = output<Model>(ctx, ab[c]);
            if (ctx.cd != ProductKind::none)
                plane(packet, ctx.cd_out[c])[i] = output<Model>(ctx, cd[c]);
            if (ctx.third == ThirdKind::none) continue;
            const Int third = ctx.third == ThirdKind::sum ? ab[c] + cd[c]
                              : takes_cd                  ? cd[c]
                                                          : ab[c];
            plane(packet, ctx.third_out[c])[i] = output<Model>(ctx, third);
        }
    }
}

// ---- final combiner and frame

template <class Model>
Int final_mapping(std::uint8_t mapping, Int identity) {
    return mapping == 1 ? Model::kOne - std::min(identity, Model::kOne) : identity;
}

template <class Model>
Int final_register(const Packet& packet, const Operand& operand, int c, int i) {
    return final_mapping<Model>(operand.mapping,
                                Model::final_identity(plane(packet, operand.plane[c])[i]));
}

template <class Model>
Int final_input(const Packet& packet, const FinalCtx& ctx, const Operand& operand, int c, int i) {
    if (operand.plane[0] == FinalCtx::kZero) return 0;
    if (operand.plane[0] == FinalCtx::kColorSum) {
        const auto term = [&](const std::int16_t* planes, std::uint8_t complement) {
            const Int x = Model::final_identity(plane(packet, planes[c])[i]);
            return complement != 0 ? Model::kOne - x : x;
        };
        const Int sum = Model::color_sum(term(ctx.spare0, ctx.complement_spare0),
                                         term(ctx.secondary, ctx.complement_secondary));
        return final_mapping<Model>(operand.mapping,
                                    ctx.clamp_color_sum != 0 ? std::min(sum, Model::kOne) : sum);
    }
    if (operand.plane[0] == FinalCtx::kFinalProduct) {
        const Int e = final_register<Model>(packet, ctx.e, c, i);
        const Int f = final_register<Model>(packet, ctx.f, c, i);
        return final_mapping<Model>(operand.mapping, Model::quotient(e * f, ctx.rounding));
    }
    return final_register<Model>(packet, operand, c, i);
}

template <class Model>
void final_combiner(Packet& packet, const FinalCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        for (int c = 0; c < 3; ++c) {
            const auto read = [&](const Operand& o) {
                return final_input<Model>(packet, ctx, o, c, i);
            };
            const Int ab = read(ctx.a) * read(ctx.b);
            const Int rest = (Model::kOne - read(ctx.a)) * read(ctx.c);
            const Int blend = ctx.round_each != 0 ? Model::quotient(ab, ctx.rounding) +
                                                        Model::quotient(rest, ctx.rounding)
                                                  : Model::quotient(ab + rest, ctx.rounding);
            const Int sum = blend + read(ctx.d);
            plane(packet, ctx.out[c])[i] = static_cast<std::int16_t>(std::min(sum, Model::kOne));
        }
        const Int alpha = final_register<Model>(packet, ctx.g, 0, i);
        plane(packet, ctx.out[3])[i] = static_cast<std::int16_t>(alpha);
    }
}

template <class Channel>
void write_channel(const StoreCtx& ctx, int pixel, int channel, Channel value) {
    auto* bytes = static_cast<std::byte*>(ctx.tile);
    std::memcpy(bytes + (pixel * 4 + channel) * static_cast<int>(sizeof(Channel)), &value,
                sizeof(Channel));
}

template <class Model>
void store(Packet& packet, const StoreCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const int pixel = packet.pixels[i];
        for (int c = 0; c < 4; ++c) {
            const std::int16_t v = plane(packet, ctx.plane[c])[i];
            switch (ctx.format) {
                case StoreFormat::rgba8:
                    write_channel(ctx, pixel, c, static_cast<std::uint8_t>(Model::to_8_bits(v)));
                    break;
                case StoreFormat::rgba16:
                    write_channel(ctx, pixel, c, static_cast<std::uint16_t>(Model::to_16_bits(v)));
                    break;
                case StoreFormat::rgba32f:
                    write_channel(ctx, pixel, c,
                                  static_cast<float>(v) / static_cast<float>(Model::kOne));
                    break;
            }
        }
    }
}

/// `filtered(upper left, upper right, lower left, lower right, wx, wy)` of every channel.
template <class Filter>
void filter_corners(Packet& packet, const FilterCtx& ctx, Filter filtered) {
    for (int i = 0; i < packet.count; ++i) {
        const Int wx = plane(packet, ctx.weight)[i], wy = plane(packet, ctx.weight + 1)[i];
        for (int c = 0; c < 4; ++c) {
            const auto corner = [&](int k) {
                return Int{plane(packet, ctx.corners + 4 * k + c)[i]};
            };
            const Int x = filtered(corner(0), corner(1), corner(2), corner(3), wx, wy);
            plane(packet, ctx.out + c)[i] = static_cast<std::int16_t>(x);
        }
    }
}

void filter_nine_bit(Packet& packet, const FilterCtx& ctx) noexcept {
    filter_corners(packet, ctx, [](Int a, Int b, Int c, Int d, Int wx, Int wy) {
        const auto lerp = [](Int from, Int to, Int w) {
            return shift_half_up((256 - w) * from + w * to, 8);
        };
        return lerp(lerp(a, b, wx), lerp(c, d, wx), wy);
    });
}

void filter_wide(Packet& packet, const FilterCtx& ctx) noexcept {
    filter_corners(packet, ctx, [](Int a, Int b, Int c, Int d, Int wx, Int wy) {
        const Int top = (256 - wx) * a + wx * b, bottom = (256 - wx) * c + wx * d;
        return shift_half_up((256 - wy) * top + wy * bottom, 16);
    });
}

// ---- blending

/// A channel of a frame of whole numbers, `One` of which are 1.
template <class Channel, Int One>
struct WholeFrame {
    using Value = Int;
    static constexpr Int kOne = One;
    template <class Model>
    static Int of_code(Int v) {
        return sizeof(Channel) == 1 ? Model::to_8_bits(v) : Model::to_16_bits(v);
    }
    static Int of_constant(float x) { return static_cast<Int>(x * static_cast<float>(One) + 0.5F); }
    static Int sum(Int a, Int fa, Int b, Int fb) { return rounded(a * fa + b * fb); }
    static Int difference(Int a, Int fa, Int b, Int fb) { return rounded(a * fa - b * fb); }
    /// floor(p / One + 1/2) = floor((2 p + One) / (2 One)); negative ones are clamped anyhow.
    static Int rounded(Int p) { return p <= 0 ? 0 : std::min((2 * p + One) / (2 * One), One); }
};
struct FloatFrame {
    using Value = float;
    static constexpr float kOne = 1.0F;
    template <class Model>
    static float of_code(Int v) {
        return static_cast<float>(v) / static_cast<float>(Model::kOne);
    }
    static float of_constant(float x) { return x; }
    static float sum(float a, float fa, float b, float fb) {
        return minimum(maximum(a * fa + b * fb, 0.0F), 1.0F);
    }
    static float difference(float a, float fa, float b, float fb) {
        return minimum(maximum(a * fa - b * fb, 0.0F), 1.0F);
    }
};

template <class Frame>
typename Frame::Value blend_factor(const BlendFactorCtx& factor, int c,
                                   const typename Frame::Value* source,
                                   const typename Frame::Value* destination,
                                   const float* constant) {
    typename Frame::Value f = 0;
    switch (factor.operand) {
        case BlendOperand::zero:
            break;
        case BlendOperand::source_color:
            f = source[c];
            break;
        case BlendOperand::source_alpha:
            f = source[3];
            break;
        case BlendOperand::destination_color:
            f = destination[c];
            break;
        case BlendOperand::destination_alpha:
            f = destination[3];
            break;
        case BlendOperand::constant_color:
            f = Frame::of_constant(constant[c]);
            break;
    }
    return factor.inverted != 0 ? Frame::kOne - f : f;
}

template <class Model, class Channel, class Frame>
void blend_frame(const Packet& packet, const BlendCtx& ctx) {
    using Value = typename Frame::Value;
    for (int i = 0; i < packet.count; ++i) {
        std::byte* const at = static_cast<std::byte*>(ctx.tile) +
                              static_cast<std::size_t>(packet.pixels[i]) * 4 * sizeof(Channel);
        Channel pixel[4];
        std::memcpy(pixel, at, sizeof pixel);
        Value s[4], d[4];
        for (int c = 0; c < 4; ++c) {
            s[c] = Frame::template of_code<Model>(plane(packet, ctx.plane[c])[i]);
            d[c] = static_cast<Value>(pixel[c]);
        }
        for (int c = 0; c < 4; ++c) {
            const Value fs = blend_factor<Frame>(ctx.source, c, s, d, ctx.constant);
            const Value fd = blend_factor<Frame>(ctx.destination, c, s, d, ctx.constant);
            Value result = 0;
            switch (ctx.sum) {
                case BlendSum::add:
                    result = Frame::sum(s[c], fs, d[c], fd);
                    break;
                case BlendSum::subtract:
                    result = Frame::difference(s[c], fs, d[c], fd);
                    break;
                case BlendSum::reverse_subtract:
                    result = Frame::difference(d[c], fd, s[c], fs);
                    break;
                case BlendSum::min:
                    result = s[c] < d[c] ? s[c] : d[c];
                    break;
                case BlendSum::max:
                    result = s[c] > d[c] ? s[c] : d[c];
                    break;
            }
            pixel[c] = static_cast<Channel>(result);
        }
        std::memcpy(at, pixel, sizeof pixel);
    }
}

template <class Model>
void blend(Packet& packet, const BlendCtx& ctx) noexcept {
    switch (ctx.format) {
        case StoreFormat::rgba8:
            return blend_frame<Model, std::uint8_t, WholeFrame<std::uint8_t, 255>>(packet, ctx);
        case StoreFormat::rgba16:
            return blend_frame<Model, std::uint16_t, WholeFrame<std::uint16_t, 65535>>(packet, ctx);
        case StoreFormat::rgba32f:
            return blend_frame<Model, float, FloatFrame>(packet, ctx);
    }
}

// ---- fragment tests

void alpha_test(Packet& packet, const AlphaTestCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        const std::int16_t alpha = plane(packet, ctx.plane)[i];
        const bool pass = alpha < ctx.reference   ? ctx.pass_less != 0
                          : alpha > ctx.reference ? ctx.pass_greater != 0
                                                  : ctx.pass_equal != 0;
        if (!pass) ctx.stored[i] = kNoPixel;
    }
}

void keep(Packet& packet, const KeepCtx& ctx) noexcept {
    for (int i = 0; i < packet.count; ++i) {
        if (!(attribute(packet, ctx.attribute)[i] > 0.0F)) ctx.stored[i] = kNoPixel;
    }
}

void late_depth(Packet& packet, const LateDepthCtx& ctx) noexcept {
    for (int r = 0; r < ctx.run_count; ++r) {
        const DepthRun& run = ctx.runs[r];
        for (int i = run.first; i < run.first + run.count; ++i) {
            const int pixel = ctx.stored[i];
            if (pixel == kNoPixel) continue;
            float depth = depth_at(run, tile_x(pixel), tile_y(pixel));
            bool lives = true;
            if (ctx.attribute >= 0) {
                depth = attribute(packet, ctx.attribute)[i];
                lives = depth >= 0.0F && depth <= 1.0F;
            }
            if (!lives || !passes(ctx, depth, ctx.depth[pixel])) {
                ctx.stored[i] = kNoPixel;
                continue;
            }
            if (ctx.write == 0) continue;
            ctx.depth[pixel] = depth;
            float& far = ctx.block_far[pixel / kBlockPixels];
            far = maximum(depth, far);
        }
    }
}

}  // namespace

const KernelTable& table_reference() noexcept {
    static constexpr KernelTable table{
        .isa = "reference",
        .lanes = 1,
        .transform = transform,
        .light_vertices = light_vertices,
        .setup = setup,
        .clear_words = clear_words,
        .rasterize = rasterize,
        .rasterize_small = rasterize_small,
        .rasterize_tiny = rasterize_tiny,
        .cover = cover,
        .collect = collect,
        .attribute_planes = attribute_planes,
        .attributes = attributes,
        .lighting = lighting,
        .encode_nine_bit = encode<NineBit>,
        .encode_wide = encode<Wide>,
        .address = address,
        .fetch_nine_bit = fetch<NineBit>,
        .fetch_wide = fetch<Wide>,
        .decode_nine_bit = decode<number_nine_bit>,
        .decode_wide = decode<number_wide>,
        .affine = affine,
        .dot_product = dot_product,
        .hemisphere = hemisphere,
        .offset = offset,
        .reflect = reflect,
        .quotient = quotient,
        .angle = angle,
        .cull = cull,
        .dim_nine_bit = dim<NineBit>,
        .dim_wide = dim<Wide>,
        .cube_face = cube_face,
        .plane_footprint = plane_footprint,
        .quad_footprint = quad_footprint,
        .probe_extent = probe_extent,
        .probe_point = probe_point,
        .probe_sum = probe_sum,
        .probe_mean = probe_mean,
        .level_of_detail = level_of_detail,
        .level_address = level_address,
        .texel_corner = texel_corner,
        .fetch_hilo = fetch_hilo,
        .fetch_words = fetch_words,
        .fetch_quartet = fetch_quartet,
        .prefetch_quartet = prefetch_quartet,
        .look_up_table = look_up_table,
        .average_table = average_table,
        .blend_levels = blend_levels,
        .hilo = hilo,
        .portion_nine_bit = portion<NineBit>,
        .portion_wide = portion<Wide>,
        .final_nine_bit = final_combiner<NineBit>,
        .final_wide = final_combiner<Wide>,
        .filter_nine_bit = filter_nine_bit,
        .filter_wide = filter_wide,
        .store_nine_bit = store<NineBit>,
        .store_wide = store<Wide>,
        .blend_nine_bit = blend<NineBit>,
        .blend_wide = blend<Wide>,
        .alpha_test = alpha_test,
        .keep = keep,
        .late_depth = late_depth,
    };
    return table;
}

}  // namespace burnish
