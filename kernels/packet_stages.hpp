#pragma once

#include <cstdint>

#include "kernels/packet.hpp"

/// Arguments of the stages that shade a packet. Contract header: plain data, no functions.
/// Floats: IEEE single precision, each operation rounded, in the order written, nothing fused.
/// min(a, b) is a < b ? a : b and max(a, b) is a > b ? a : b, so a NaN in a yields b.
/// Numbers of the two models: docs/numbers.md.
namespace burnish {

/// Consecutive fragments of one triangle.
struct Run {
    int first, count;                 ///< fragments of the packet
    std::int32_t offset_x, offset_y;  ///< tile pixel (0, 0) minus the reference pixel
};

/// Perspective-correct interpolation: attribute plane k = (equation k + 1 at the pixel) * w, with
/// w = 1 / (equation 0 at the pixel). An equation at a fragment of run r is
/// (origin + dx * x) + dy * y, x = float(tile x + offset_x), y likewise; origin, dx and dy of
/// equation e are equations[(3 e + c) * kAttributeStride + r] with c = 0, 1, 2. Nothing is done
/// where attribute_count is 0.
struct AttributesCtx {
    const Run* runs;  ///< cover fragments 0 .. count - 1 in order
    int run_count;    ///< 1 .. kPacketSize
    int attribute_count;
    const float* equations;  ///< 3 * (attribute_count + 1) rows, readable 16 past the last run
};

/// Light, view and half vectors in the interpolated tangent frame, per fragment.
/// l = light - position * light_w or, where light_w is 0, light; v = eye - position * eye_w; both
/// normalised: times 1 / sqrt(dot(x, x)), dot(a, b) = (ax*bx + ay*by) + az*bz. h = l + v,
/// normalised likewise, or (l + v) * 0.5 if `raw_half`.
/// If `orthonormal` the frame becomes N = N normalised, T = T - N * dot(N, T) normalised, and, with
/// c = cross(N, T) = (Ny*Tz - Nz*Ty, Nz*Tx - Nx*Tz, Nx*Ty - Ny*Tx), B = dot(c, B) < 0 ? -c : c.
/// A vector x leaves as three attribute planes dot(T, x) * 0.5 + 0.5, dot(B, x) * 0.5 + 0.5,
/// dot(N, x) * 0.5 + 0.5; n_dot_l as one plane max(dot(N, l), 0), h_dot_l as max(dot(h, l), 0).
struct LightingCtx {
    int frame;       ///< first of 12 attribute planes: T, B, N, position, three components each
    float light[3];  ///< object space; towards the light where light_w is 0, else its position
    float light_w;   ///< 0 or 1
    float eye[3];    ///< object space, see eye_w
    int half_vector, light_vector, view_vector;  ///< first of three planes to write, or -1
    int n_dot_l, h_dot_l;                        ///< planes to write, or -1
    float eye_w = 1.0F;                          ///< 0: `eye` is the direction towards the viewer
    std::uint8_t raw_half = 0;
    std::uint8_t orthonormal = 0;
};

/// One attribute plane to one register plane: code = int(min(max(x * one + 0.5, 0), one)) with
/// one = 255 (nine_bit) or 16384 (wide); NaN gives 0.
struct EncodeCtx {
    int attribute;
    int plane;
};

enum class AddressMode : std::uint8_t { repeat, clamp_to_edge, clamp_to_border, mirrored_repeat };

/// Texel addresses and weights from coordinates u, v (v downward: row 0 at 0).
/// Where there is a q, u = u / q and v = v / q first.
/// repeat: f = u - floor(u); mirrored_repeat: f = u - 2 * floor(u * 0.5), and 2 - f where that is
/// above 1; else f = u. Then f = min(max(f, 0), 1), clamp_to_border min(max(f, -1), 2) (NaN gives
/// the lower end), x = floor(f * float(256 * width)) - (linear ? 128 : 0), texel x0 = x >> 8,
/// weight = x & 255.
/// repeat: x0 < 0 becomes x0 + width, x0 >= width becomes x0 - width.
/// clamp_to_border: x0 < -1 becomes -1 with weight 0; x0 >= width becomes width with weight 0.
/// Others: x0 < 0 becomes 0 with weight 0; x0 >= width becomes width - 1.
/// rectangle: coordinates are in texels; 1, 2 and 256 * width above are width, width + 1 and 256.
/// Not linear: weight 0. The right and the lower neighbours are in memory beside and below the
/// texel in every case. Rows likewise. Offset = y0 * pitch + x0 * 2^texel_shift.
struct AddressCtx {
    int u, v;                           ///< attribute planes
    int q;                              ///< attribute plane, or -1
    std::int32_t width, height, pitch;  ///< texels, texels, bytes
    AddressMode mode_s, mode_t;
    std::uint8_t linear;
    std::uint8_t rectangle = 0;    ///< only with modes that clamp
    std::uint8_t texel_shift = 2;  ///< 2: four bytes a texel; 3: eight; 5: 32
};

/// Bilinear texels of up to four textures of one size at the packet's addresses; left and right are
/// 4 bytes apart, the rows one pitch. Texture k gives four planes r, g, b, a from plane[k] on.
/// A texel is four signed bytes 127 - t of r, g, b, a; of a signed channel t = value + 128.
/// nine_bit: h = ((256 - wx) * t_left + wx * t_right + 128) >> 8 for both rows,
///   v = ((256 - wy) * h_top + wy * h_bottom + 128) >> 8; code = v, signed 2 * (v - 128).
/// wide: h = (256 - wx) * t_left + wx * t_right,
///   v = ((256 - wy) * h_top + wy * h_bottom + 128) >> 8 (0 .. 65280);
///   code = (v + (v >> 8) + 2) >> 2, signed (v - 32768 + 1) >> 1.
struct FetchCtx {
    static constexpr int kMaxTextures = 4;
    static constexpr std::uint8_t kAllSigned = 15;
    const std::uint8_t* texels[kMaxTextures];
    int plane[kMaxTextures];
    std::uint8_t is_signed[kMaxTextures];  ///< bit c: channel c
    int count;                             ///< 1 .. kMaxTextures
    std::int32_t pitch;                    ///< bytes
};

/// Two words a texel: planes h, l = plane, plane + 1. Words t are signed; for both rows
/// h = ((256 - wx) * t_left + wx * t_right + 128) >> 8, then
/// ((256 - wy) * h_top + wy * h_bottom + 128) >> 8, which is what the plane gets.
struct FetchHiloCtx {
    const std::uint8_t* texels;
    int plane;
    std::int32_t pitch;  ///< bytes
};

/// Four words a texel, value - 32768, 8 bytes from left to right, as wide codes in four planes:
/// x = ((256 - wy) * ((256 - wx) * t_left + wx * t_right) + wy * (the same below) + 2^15) >> 16,
/// code = (x + 32768 + 2) >> 2.
struct FetchWordsCtx {
    const std::uint8_t* texels;
    int plane;
    std::int32_t pitch;  ///< bytes
};

/// Four textures of such texels between each other, 32 bytes from left to right: texture k's texel
/// begins 8 k bytes on and goes to four planes from plane[k] on, or nowhere where that is -1;
/// planes of channels that `channels` leaves out stay as they are.
struct FetchQuartetCtx {
    static constexpr int kTextures = 4;
    static constexpr int kTexelBytes = 32, kNextTexture = 8;
    const std::uint8_t* texels;
    int plane[kTextures];
    std::int32_t pitch;                                   ///< bytes
    std::uint8_t channels[kTextures] = {15, 15, 15, 15};  ///< bit c: channel c
};

/// Has texels of a quartet brought closer that a packet's addresses ask for, while other stages
/// run. Changes nothing.
struct PrefetchQuartetCtx {
    const std::uint8_t* texels;
    std::int32_t pitch;  ///< bytes
};

/// A function of one or two wide registers, looked up. A texel is two words, value - 32768: its own
/// and that of the texel below, 4 bytes from left to right. Of either axis the code v in `plane` is
/// the coordinate ((v / 16384) * scale + offset) / divisor, with which AddressCtx's clamp_to_edge,
/// linear, finds texel and weight; without a second axis row 0 and weight 0. Filtered as in
/// FetchWordsCtx; the code goes to every plane of `out` that is not -1.
struct LookUpTableCtx {
    struct Axis {
        int plane;  ///< -1: there is none
        std::int32_t size;
        float scale, offset, divisor;
    };
    const std::uint8_t* texels;
    Axis s, t;
    std::int32_t pitch;  ///< bytes
    int out[4];
    /// Without a second axis, if not null: what all of this gives for code v, at v & 65535.
    const std::int16_t* codes = nullptr;
};

/// The mean of a function of a wide register over what the register goes through between pixels,
/// from a summed table (Crow, SIGGRAPH 1984, in one dimension): the integral of the lerps between
/// its texels. Fragments are whole quads as in QuadFootprintCtx; d is the larger of |right - left|
/// in the fragment's own row and |lower - upper| in its own column, of the codes in plane s.plane.
/// A texel i is 8 bytes: the words t[i] and t[i + 1], value - 32768, and 32 bits with the sum of
/// t[j] + t[j + 1] over j < i, twice the integral up to its centre. The last one's t[i + 1] is
/// t[i].
/// c = v / 16384, low = max(c - d * reach, least), high = min(c + d * reach, most). In 1/256 texel
/// from the first centre, p = floor(((x * scale + offset) / divisor) * float(256 * size)) - 128
/// with the axis of LookUpTableCtx, and q = p limited to 0 .. 256 * (size - 1): texel i = q >> 8,
/// w = q & 255. Beyond the first and the last centre the function stays what it is there:
///   r = float(w) * float(512 * t[i] + w * (t[i + 1] - t[i])) * 2^-16
///       + float(p - q) * float(t[i]) * 2^-7,
///   n = float(sum of high - sum of low) + (r of high - r of low),
/// with a second axis n = n + (n of the row below - n) * (its weight * 2^-8);
/// x = floor((n * 128) / float(p of high - p of low) + 1/2), limited to -32768 .. 32767,
/// code = (x + 32768 + 2) >> 2. Where p of high <= p of low the code is that of LookUpTableCtx.
/// max(a, b) = a > b ? a : b, min(a, b) = a < b ? a : b.
struct AverageTableCtx {
    const std::uint8_t* texels;
    LookUpTableCtx::Axis s, t;
    float reach;         ///< half a step as a coordinate, by code: 2^(bias - 15)
    float least, most;   ///< coordinates beyond which the argument never goes; within -8 .. 8
    std::int32_t pitch;  ///< bytes
    int out[4];          ///< planes, or -1
};

/// Planes out + c = a + (b - a) * w / 256 of planes a + c and b + c, rounded half up, with the low
/// 8 bits of plane `weight` as w. Channels of `doubled` hold even codes 2 n; n is what is rounded.
struct BlendLevelsCtx {
    int a, b, out;  ///< first planes; out may be a or b
    int channels;   ///< 1 .. 4
    int weight;     ///< plane
    std::uint8_t doubled;
    std::uint8_t words = 0;  ///< 1: a and b are any words; 0: |a - b| < 2^15
};

/// Attribute planes out, out + 1 of the words x in planes `plane`, plane + 1:
/// float(x + 32768) / 65535, signed float(x) / 32768.
struct HiloCtx {
    int plane, out;
    std::uint8_t is_signed;
};

/// The face of a cube map that a direction (s, t, r) meets, 0 .. 5: +x -x +y -y +z -z, and where.
/// |s| >= |t| and |s| >= |r|: an x face; else |t| >= |r|: a y face; else a z face. The negative one
/// where that coordinate is < 0. With m its absolute value and (a, b) =
///   +x (-r, -t)  -x (r, -t)  +y (s, r)  -y (s, -r)  +z (s, -t)  -z (-s, -t):
/// u = (a / m) * 0.5 + 0.5, v = (b / m) * 0.5 + 0.5.
struct CubeFaceCtx {
    int s, t, r;  ///< attribute planes
    int u, v;     ///< attribute planes to write
    int face;     ///< plane to write
};

/// How many texels of level 0 a pixel covers, squared: attribute plane `out`. With D the divisor of
/// the coordinates, and derivatives along x and y,
///   u = S / D, u' = ((S' - u * D') / D) * scale[0], and so with T and R;
///   out = max(square along x, square along y), square = (u' * u' + v' * v') + r' * r', the last
///   only where there is an r. max(a, b) = a > b ? a : b.
/// For a cube map S, T and D are what CubeFaceCtx calls a, b and m at the fragment's face.
struct FootprintCtx {
    int s, t, r, q;  ///< attributes; r and q may be -1, cube: q is
    std::uint8_t cube;
    float scale[3];  ///< texels per unit of s, t, r; cube: half a side, twice
    int out;
};

/// From the equations of interpolated attributes: S is number s + 1, D number q + 1, or number 0
/// where there is no q. Values at the pixel as in AttributesCtx, derivatives the equations' dx and
/// dy; for a cube map the signs of a and b are applied to value and derivatives alike.
struct PlaneFootprintCtx {
    FootprintCtx footprint;
    AttributesCtx runs;  ///< attribute_count is not looked at
};

/// From differences between fragments of 2x2 quads: fragments 4 k .. 4 k + 3 are upper left, upper
/// right, lower left, lower right. S' along x = right - left in the fragment's own row, along y =
/// lower - upper in its own column; D is attribute q, or 1 with no difference. Groups are whole.
struct QuadFootprintCtx {
    FootprintCtx footprint;
};

/// A pixel's footprint on a flat texture, without r, divided among probes along its longer axis.
/// Squares as in FootprintCtx from the equations of PlaneFootprintCtx, `along_x` and `along_y`:
///   longest = max(along_x, along_y), shortest = max(min(along_x, along_y), 1),
///   n = min(max(ceil(sqrt(longest / shortest) - 2^-8), 1), most), the number of probes;
///   footprint.out = longest / (n * n), the square of what each of them covers;
///   step, step + 1 = u' / (n + 1), v' / (n + 1), before `scale`, where along_x > along_y along x,
///   else along y; 0 where n is 1.
/// max(a, b) = a > b ? a : b, min(a, b) = a < b ? a : b. 2^-8: what is as long as it is wide, but
/// for rounding, has one probe. Source: EXT_texture_filter_anisotropic, 1999: N = min(ceil(Pmax /
/// Pmin), maxAniso), lambda = log2(Pmax / N), probes at i / (N + 1) - 1/2 of Pmax, i = 1 .. N; Pmin
/// is at least a texel here.
struct ProbeExtentCtx {
    FootprintCtx footprint;
    AttributesCtx runs;  ///< attribute_count is not looked at
    int probes;          ///< attribute plane to write with n
    int step;            ///< attribute planes to write: step, step + 1
    float most;          ///< 2 .. 16
};

/// Where probe k of n looks: u and v, over q where there is a q, moved to
///   to = u + step * i, to + 1 = v + (step + 1) * i, i = min(k, n - 1) - (n - 1) * 0.5.
struct ProbePointCtx {
    int u, v;    ///< attribute planes
    int q;       ///< attribute plane, or -1
    int step;    ///< attribute planes: step, step + 1
    int probes;  ///< attribute plane of n, whole, 1 .. 16
    int to;      ///< attribute planes to write: to, to + 1
    int probe;   ///< k, 0 .. 15
};

/// Sums of what probes see, one attribute plane from `sum` on for every channel:
/// probe_sum: sum = (k == 0 ? 0 : sum) + (k < n ? code : 0).
/// probe_mean: code = floor(sum / n + 1/2); channels of `doubled` hold even codes 2 m, and m is
/// what is rounded: code = 2 floor((sum / 2) / n + 1/2). Floats give both exactly: |sum| < 2^20.
struct ProbeSumCtx {
    static constexpr int kMaxChannels = 16;
    int probes;                        ///< attribute plane of n, whole, 1 .. 16
    int probe;                         ///< k; probe_mean does not look at it
    int sum;                           ///< the first attribute plane
    int channels;                      ///< 1 .. kMaxChannels
    std::int16_t plane[kMaxChannels];  ///< of the codes: probe_sum reads, probe_mean writes
    std::uint16_t doubled;             ///< bit c: channel c
};

/// Level of detail in 1/256 from the footprint f in attribute plane `footprint`:
/// f = min(max(f, 2^-64), 2^64) (NaN gives 2^-64), f = 2^e (1 + m / 2^23);
/// 128 e + (how many entries of kLog2Step are <= m) + bias, clamped to 0 .. max.
/// That is log2(sqrt(f)) to the nearest 1/256.
struct LevelOfDetailCtx {
    int footprint;
    int plane;
    std::int32_t bias, max;  ///< 1/256 level; |bias| <= 4096
};

/// Which level an address is in: 0; the nearest of lambda, min((lambda + 127) >> 8, last); the one
/// above, lambda >> 8; or the one below it, at most the last.
enum class LevelChoice : std::uint8_t { base, nearest, floor, ceiling };

/// Texel addresses and weights as in AddressCtx, in levels, faces and slices.
/// lambda = plane `lambda`, or 0; linear = lambda > 0 ? min_linear : mag_linear.
/// Offset = level.offset + y0 * pitch + x0 * texel_bytes + (face or slice) * layer_bytes.
/// A slice comes from r and the level's depth as a texel does from u: z0; behind it z0 + 1, which
/// is 0 again for repeat, depth - 1 for clamp_to_edge and mirrored_repeat, at most depth for
/// clamp_to_border. The weight of the one behind goes to plane `slice_weight`.
struct LevelAddressCtx {
    static constexpr int kMaxLevels = 15;
    struct Level {
        std::int32_t width, height, depth, offset;
    };

    int u, v;          ///< attribute planes
    int q;             ///< attribute plane that divides u, v, r; or -1
    int r;             ///< attribute plane of slices, or -1
    int face;          ///< plane of cube faces, or -1
    int lambda;        ///< plane, or -1
    int slice_weight;  ///< plane to write, or -1
    AddressMode mode_s, mode_t, mode_r;
    LevelChoice choice;
    std::uint8_t behind;  ///< take the slice behind
    std::uint8_t mag_linear, min_linear;
    std::uint8_t rectangle;
    std::int32_t pitch, layer_bytes, texel_bytes;
    std::int32_t level_count;
    Level levels[kMaxLevels];
};

/// The centre of one of the four texels around a sample point, and what the four weigh.
/// The level is that of `choice` by lambda = plane `lambda`, or 0, as in LevelAddressCtx;
/// linear = lambda > 0 ? min_linear : mag_linear. Where there is a q, u = u / q and v = v / q
/// first. Of u, with n texels on the axis and steps = float(256 * n), rectangle: 256,
///   repeat: whole = floor(u); mirrored_repeat: whole = 2 * floor(u * 0.5); others: whole = 0;
///   f = u - whole, mirrored_repeat: g = f > 1 ? 2 - f : f, others: g = f;
///   x = floor(g * steps) - (linear ? 128 : 0), x0 = floor(x * 2^-8), weight = x - x0 * 256, within
///   0 .. 255 (NaN gives 0), 0 if not linear;
///   c = (x0 * 256 + (right ? 384.5 : 128.5)) / steps, mirrored_repeat with f > 1: c = 2 - c;
///   to = whole + c: the middle of the 1/256 texel at whose lower end the centre is, so that
///   AddressCtx finds nothing but that texel.
/// v, with `below`, likewise.
struct TexelCornerCtx {
    int u, v;    ///< attribute planes
    int q;       ///< attribute plane, or -1
    int lambda;  ///< plane, or -1
    int to;      ///< attribute planes: to, to + 1
    int weight;  ///< planes to write: of the right texels and, next, of the lower ones
    int level;   ///< plane to write with 256 * the level, or -1
    AddressMode mode_s, mode_t;
    LevelChoice choice;
    std::uint8_t right, below;  ///< which of the four
    std::uint8_t mag_linear, min_linear;
    std::uint8_t rectangle;
    std::int32_t level_count;
    LevelAddressCtx::Level levels[LevelAddressCtx::kMaxLevels];  ///< depth, offset: not looked at
};

/// Colours of four corners become one. Corner k has four planes from `corners` + 4 k on: upper
/// left, upper right, lower left, lower right; wx and wy are the planes weight, weight + 1.
/// nine_bit: h = ((256 - wx) * left + wx * right + 128) >> 8 for both rows, then
///   ((256 - wy) * h_top + wy * h_bottom + 128) >> 8.
/// wide: ((256 - wy) * ((256 - wx) * left + wx * right) + wy * (the same below) + 2^15) >> 16.
struct FilterCtx {
    static constexpr int kCorners = 4;
    int corners;
    int weight;
    int out;  ///< first of four planes, none of those above
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
    /// Wide: the caller promises that operands' planes hold -16384 .. 16384, for which there is a
    /// quicker way; with other codes results may be anything.
    std::uint8_t bounded;
    std::int16_t mux_plane;  ///< spare0.alpha, for mux
    /// Planes; unused outputs name one and the same trash plane.
    std::int16_t ab_out[3], cd_out[3], third_out[3];
};

/// The final combiner: planes out[0 .. 2] = min(1, A*B + (1 - A)*C + D), out[3] = G.
/// Mappings 0 and 1 only. An operand with plane[0] == kColorSum or kFinalProduct reads that
/// pseudo-register instead; B, C or D with kZero is 0, whatever its mapping.
struct FinalCtx {
    static constexpr std::int16_t kColorSum = -1;
    static constexpr std::int16_t kFinalProduct = -2;
    static constexpr std::int16_t kZero = -3;
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
