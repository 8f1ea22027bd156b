#pragma once

#include <cstdint>

#include "kernels/packet.hpp"

/// Arguments of the stages that shade a packet. Contract header: plain data, no functions.
/// Floats: IEEE single precision, each operation rounded, in the order written, nothing fused.
/// min(a, b) is a < b ? a : b and max(a, b) is a > b ? a : b, so a NaN in a yields b.
/// Numbers of the two models: docs/numbers.md.
namespace burnish {

/// Value at pixel (px, py) of the window: (origin + dx * x) + dy * y, x = float(px - reference x).
struct AttributePlane {
    float origin, dx, dy;
};

/// Consecutive fragments of one triangle.
struct Run {
    const AttributePlane* planes;     ///< 1/w, then attribute_count times attribute/w
    int first, count;                 ///< fragments of the packet
    std::int32_t offset_x, offset_y;  ///< tile pixel (0, 0) minus the reference pixel
};

/// Perspective-correct interpolation: attribute plane k = (planes[k + 1] at the pixel) * w, with
/// w = 1 / (planes[0] at the pixel). x of a fragment = float(tile x + offset_x).
struct AttributesCtx {
    const Run* runs;  ///< cover fragments 0 .. count - 1 in order
    int run_count;
    int attribute_count;
};

/// Light, view and half vectors in the interpolated tangent frame, per fragment.
/// l = light - position * light_w, v = eye - position, both normalised by 1 / sqrt(dot(x, x));
/// h = l + v, normalised likewise. dot(a, b) = (ax*bx + ay*by) + az*bz.
/// A vector x leaves as three attribute planes dot(T, x) * 0.5 + 0.5, dot(B, x) * 0.5 + 0.5,
/// dot(N, x) * 0.5 + 0.5; n_dot_l as one plane max(dot(N, l), 0).
struct LightingCtx {
    int frame;       ///< first of 12 attribute planes: T, B, N, position, three components each
    float light[3];  ///< object space; towards the light where light_w is 0, else its position
    float light_w;   ///< 0 or 1
    float eye[3];    ///< object space
    int half_vector, light_vector, view_vector;  ///< first of three planes to write, or -1
    int n_dot_l;                                 ///< plane to write, or -1
};

/// One attribute plane to one register plane: code = int(min(max(x * one + 0.5, 0), one)) with
/// one = 255 (nine_bit) or 16384 (wide); NaN gives 0.
struct EncodeCtx {
    int attribute;
    int plane;
};

enum class AddressMode : std::uint8_t { repeat, clamp_to_edge };

/// Texel addresses and weights from coordinates u, v (v downward: row 0 at 0).
/// Where there is a q, u = u / q and v = v / q first.
/// repeat: f = u - floor(u); clamp_to_edge: f = u. Then f = min(max(f, 0), 1) (NaN gives 0),
/// x = int(f * float(256 * width)) - (linear ? 128 : 0), texel x0 = x >> 8, weight = x & 255.
/// repeat: x0 < 0 becomes x0 + width, x0 >= width becomes x0 - width.
/// clamp_to_edge: x0 < 0 becomes 0 with weight 0; x0 >= width becomes width - 1.
/// Not linear: weight 0. The right and the lower neighbours are in memory beside and below the
/// texel in every case. Rows likewise. Offset = y0 * pitch + 4 * x0.
struct AddressCtx {
    int u, v;                           ///< attribute planes
    int q;                              ///< attribute plane, or -1
    std::int32_t width, height, pitch;  ///< texels, texels, bytes
    AddressMode mode_s, mode_t;
    std::uint8_t linear;
};

/// Bilinear texels of up to four textures of one size at the packet's addresses; left and right are
/// 4 bytes apart, the rows one pitch. Texture k gives four planes r, g, b, a from plane[k] on.
/// A texel t is four bytes r, g, b, a; those of a signed texture are value + 128.
/// nine_bit: h = ((256 - wx) * t_left + wx * t_right + 128) >> 8 for both rows,
///   v = ((256 - wy) * h_top + wy * h_bottom + 128) >> 8; code = v, signed 2 * (v - 128).
/// wide: h = (256 - wx) * t_left + wx * t_right,
///   v = ((256 - wy) * h_top + wy * h_bottom + 128) >> 8 (0 .. 65280);
///   code = (v + (v >> 8) + 2) >> 2, signed (v - 32768 + 1) >> 1.
struct FetchCtx {
    static constexpr int kMaxTextures = 4;
    const std::uint8_t* texels[kMaxTextures];
    int plane[kMaxTextures];
    std::uint8_t is_signed[kMaxTextures];
    int count;           ///< 1 .. kMaxTextures
    std::int32_t pitch;  ///< bytes
};

/// An input of a combiner portion: the register planes of its components and the mapping, by the
/// numbers 0 .. 7 of the hardware (burnish::Mapping in the same order). kIdealHalf + 2 .. 5 are
/// expand .. half_bias_negate with 1/2 = 127.5, nine-bit portions only.
struct Operand {
    static constexpr std::uint8_t kIdealHalf = 8;

    std::int16_t plane[3];
    std::uint8_t mapping;
};

enum class ProductKind : std::uint8_t { none, multiply, dot };
enum class ThirdKind : std::uint8_t { none, sum, mux };
enum class OutputScale : std::uint8_t { one, two, four, half };
/// x / 255 to nearest, towards zero, or floor(x / 256). The wide model knows `nearest` only.
enum class Rounding : std::uint8_t { nearest, truncate, shift8 };

/// One portion of a general combiner stage (docs/numbers.md has the arithmetic of both models).
/// For component c in 0 .. components - 1: AB = A[c] * B[c] or the dot product over components
/// 0, 1, 2 (then the same for every c), CD likewise, third = AB + CD or mux, from the products
/// before scale and bias; each output = clamp((x + bias) * scale). A kernel reads all its inputs of
/// a fragment before it writes any output, but output planes are never input planes.
struct PortionCtx {
    Operand a, b, c, d;
    ProductKind ab, cd;  ///< ab is never `none`; cd is none only where third is, too
    ThirdKind third;
    OutputScale scale;
    Rounding rounding;        ///< of products
    std::uint8_t halve_down;  ///< nine-bit, scale half: floor instead of half up
    std::uint8_t mux_lsb;     ///< nine-bit: mux tests bit 0 of its plane, not whether it is >= 1/2
    std::uint8_t bias_minus_half;
    std::uint8_t wide;        ///< wide model: saturate at the register's range, not at [-1, 1]
    std::uint8_t components;  ///< 1 or 3 planes to write per output
    std::int16_t mux_plane;   ///< spare0.alpha, for mux
    /// Planes; unused outputs name one and the same trash plane.
    std::int16_t ab_out[3], cd_out[3], third_out[3];
};

/// The final combiner: planes out[0 .. 2] = min(1, A*B + (1 - A)*C + D), out[3] = G.
/// Mappings 0 and 1 only. An operand with plane[0] == kColorSum or kFinalProduct reads that
/// pseudo-register instead.
struct FinalCtx {
    static constexpr std::int16_t kColorSum = -1;
    static constexpr std::int16_t kFinalProduct = -2;
    Operand a, b, c, d, e, f;
    Operand g;               ///< plane[0]
    std::int16_t spare0[3];  ///< planes that the colour sum adds
    std::int16_t secondary[3];
    Rounding rounding;        ///< of E F and of A B + (1 - A) C
    std::uint8_t round_each;  ///< nine-bit: A B and (1 - A) C are rounded apart
    std::uint8_t complement_spare0, complement_secondary;  ///< 1 - x in the colour sum
    std::uint8_t clamp_color_sum;
    std::uint8_t uses_color_sum;
    std::uint8_t uses_final_product;
    std::int16_t out[4];
};

enum class StoreFormat : std::uint8_t { rgba8, rgba16, rgba32f };

/// Codes of four planes to the pixels of the tile, which holds 4, 8 or 16 bytes each.
/// nine_bit v in 0 .. 255: v; v * 257; float(v) / 255.
/// wide v in 0 .. 16384: (v * 255 + 8192) >> 14; (v * 65535 + 8192) >> 14; float(v) / 16384.
/// Floats may be any register's: v of the whole range.
/// Only fragments 0 .. count - 1 are written.
struct StoreCtx {
    std::int16_t plane[4];
    StoreFormat format;
    void* tile;  ///< kTilePixels + 1 pixels
};

/// What a colour is multiplied with before it is blended. The factor of a channel c is
/// zero: 0; the colour of the fragment or of the pixel: its channel c; their alpha: channel 3; the
/// constant: its channel c. `inverted`: 1 - that, so that zero becomes 1.
enum class BlendOperand : std::uint8_t {
    zero,
    source_color,
    source_alpha,
    destination_color,
    destination_alpha,
    constant_color,
};
struct BlendFactorCtx {
    BlendOperand operand;
    std::uint8_t inverted;
};

/// With s of the fragment, d of the pixel and their factors fs and fd: s fs + d fd, s fs - d fd,
/// d fd - s fs, or the smaller or larger of s and d, whatever the factors are.
enum class BlendSum : std::uint8_t { add, subtract, reverse_subtract, min, max };

/// Codes of four planes, as StoreCtx takes them, blended with the pixels of the tile. s, d, factors
/// and result are values of the frame; all four channels alike.
/// rgba8, rgba16: with N = 255 or 65535 standing for 1, floor(p / N + 1/2) for the exact sum or
///   difference p of products, then clamped to 0 .. N: one rounding.
/// rgba32f: both products rounded, then their sum or difference, then min(max(p, 0), 1).
/// The constant's codes are int(constant * float(N) + 0.5).
/// Only fragments 0 .. count - 1 are written.
struct BlendCtx {
    std::int16_t plane[4];
    StoreFormat format;
    BlendSum sum;
    BlendFactorCtx source, destination;
    float constant[4];  ///< 0 .. 1
    void* tile;         ///< kTilePixels + 1 pixels
};

// Fragment tests take the packet's own list of pixels, which they write to, besides Packet::pixels:
// a fragment that fails gets kNoPixel in `stored`; what is kNoPixel already stays so.

/// Lives where the plane's code is below, equal to or above the reference and that passes.
struct AlphaTestCtx {
    std::int16_t plane;
    std::int16_t reference;
    std::uint8_t pass_less, pass_equal, pass_greater;
    std::uint16_t* stored;  ///< kPacketSize, aligned to 64 bytes
};

/// Lives where the attribute plane is > 0; a NaN is not.
struct KeepCtx {
    int attribute;
    std::uint16_t* stored;  ///< kPacketSize, aligned to 64 bytes
};

/// Depth of consecutive fragments of one triangle: as RasterizeCtx has it for TileTriangle.
struct DepthRun {
    float z, zx, zy;
    float z_low, z_high;
    int first, count;                 ///< fragments of the packet
    std::int32_t offset_x, offset_y;  ///< tile pixel (0, 0) minus the reference pixel
};

/// The depth test after shading, of fragments that are still alive: with the triangle's depth, or
/// with an attribute plane's, whose values outside [0, 1] and NaN drop the fragment. A fragment
/// that passes replaces the depth if `write`, and then raises block_far of its block if it is
/// above.
struct LateDepthCtx {
    const DepthRun* runs;  ///< cover fragments 0 .. count - 1 in order
    int run_count;
    int attribute;  ///< plane of the fragments' own depths, or -1
    std::uint8_t pass_less, pass_equal, pass_greater, write;
    float* depth;           ///< kTilePixels
    float* block_far;       ///< kTileBlocks, upper bounds of the depths of each block
    std::uint16_t* stored;  ///< kPacketSize, aligned to 64 bytes
};

}  // namespace burnish
