#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace burnish {

/// What a register of the combiner machine holds (docs/numbers.md).
enum class NumberModel {
    nine_bit,  ///< integer v in [-256, 255], value v / 255
    wide,      ///< integer v in [-2^15, 2^15 - 1], value v / 2^14
};

/// Where the half vector is computed and what of it reaches the combiners.
enum class HalfVector {
    vertex,  ///< per vertex, interpolated as a colour, never renormalised: what the first chips saw
    pixel,   ///< from the interpolated frame and position, normalised at every pixel
    cube,    ///< per vertex, not normalised, as coordinates of a cube map of unit vectors, which
             ///< takes the place of one texture unit
};

/// Whose direction the view vector is.
enum class Viewer {
    local,     ///< the eye, from every point another
    infinite,  ///< as if the eye were far away in the middle of the picture: one for all points
};

/// What the tangent frame at a pixel is made of.
enum class TangentFrames {
    /// T, B and N of the vertices, interpolated and not normalised: the contract of MikkTSpace.
    mikktspace,
    /// The same, then N normalised, T made perpendicular to it and normalised, B from both; on a
    /// machine with half vectors per vertex at the vertices.
    orthonormal,
    /// As orthonormal, from the triangle's own dP/du and dP/dv instead of the vertices' T and B:
    /// for meshes without usable tangents. Half vectors per pixel only.
    derivative,
};

/// How x = a b, of general products, of E F and of the final A B + (1 - A) C, becomes a nine-bit
/// code again.
enum class ProductRounding {
    nearest,   ///< x / 255 to nearest, as captures of the NV2A show
    truncate,  ///< x / 255 towards zero
    shift8,    ///< floor(x / 256)
};

/// The nine-bit 1/2 of the mappings expand and half_bias, for a code v. The output bias is 128 in
/// both, as captures show.
enum class ExpandRule {
    hardware,  ///< 128: 2 (v - 128) and v - 128, so that 128 is zero
    ideal,     ///< 127.5: 2 v - 255 and v - 127.5, ties to even
};

/// What the output scale 1/2 does with an odd nine-bit code.
enum class Halving {
    half_up,  ///< as captures show
    down,
};

/// Whether the final combiner rounds A B + (1 - A) C once or each product, in nine bits.
enum class LerpRounding { once, each };

/// The factor by which the offset operations with scale dim the texel.
enum class MagnitudeFactor {
    unclamped,  ///< as captures of the NV2A show; the product stops at 1
    clamped,    ///< to [0, 1], as NV_texture_shader has it
};

/// Whether texels are filtered before the program or its results are, afterwards (docs/numbers.md).
enum class FilterOrder {
    before,  ///< every map by itself, then combiners once: what hardware does
    after,   ///< the program at the four texel centres around, then a filter over its results
};

/// What texture units can do before the combiners (burnish/texture_shader.hpp).
enum class TextureOperations {
    plain,  ///< fetches by interpolated coordinates from 1D, 2D, rectangle and cube map textures
    nv2a,   ///< those of NV_texture_shader and NV_texture_shader2, and the chip's BRDF mode
    all,    ///< NV_texture_shader3, too
};

/// What the four pixels of a 2x2 quad are, inside which fetches at computed coordinates take
/// differences.
enum class Quads {
    of_triangle,  ///< one triangle's, which is extrapolated where it does not reach
    /// What is seen there of the draw, so that differences go across silhouettes and seams: for the
    /// experiment that shows it. Neither for draws that need order nor in double precision.
    of_pixels,
};

/// How the tables of reflectance models are filtered where their coordinates change from pixel to
/// pixel (docs/table_filter.md); in double precision, max(0, s)^m of the Blinn-Phong family.
enum class TableFilter {
    point,  ///< not at all
    mip,    ///< mip levels; in double precision of 256 values
    exact,  ///< the mean over what the coordinate goes through, by sums: the power's integral
};

/// A machine profile: data that says what a program may use and how numbers behave.
/// Any field may be overridden after `machine_profile()`; `validate()` checks the result.
struct Machine {
    std::string name = "ideal";
    int texture_units = 16;       ///< 1 .. 16
    int general_stages = 16;      ///< 0 .. 16
    bool stage_constants = true;  ///< const0 and const1 may differ from stage to stage
    bool stage_fetches = true;    ///< texture fetches between general stages
    TextureOperations texture_operations = TextureOperations::all;
    MagnitudeFactor magnitude_factor = MagnitudeFactor::clamped;
    NumberModel numbers = NumberModel::wide;
    // Choices of the nine-bit model; the defaults are those of the NV2A.
    ProductRounding product_rounding = ProductRounding::nearest;
    ExpandRule expand = ExpandRule::hardware;
    Halving halving = Halving::half_up;
    LerpRounding lerp_rounding = LerpRounding::once;
    FilterOrder filter_order = FilterOrder::before;
    /// Programs that need more than the machine has are split into passes, where they can be
    /// (burnish/multipass.hpp), instead of refused.
    bool multipass = false;
    HalfVector half_vector = HalfVector::pixel;
    int half_vector_size = 64;  ///< HalfVector::cube: texels a side, 1 .. 1024
    /// HalfVector::cube: what a texel's component is rounded to, 8, 9 or 16 bits; registers of nine
    /// bits take 8.
    int half_vector_bits = 8;
    /// Else h is (l + v) / 2 of the unit vectors l and v. A cube map needs the default.
    bool normalise_half_vector = true;
    Viewer viewer = Viewer::local;
    TangentFrames tangent_frames = TangentFrames::mikktspace;
    int subpixel_bits = 8;    ///< 4 .. 8: vertices are snapped to 2^-subpixel_bits pixel
    bool snap_floor = false;  ///< snap by floor, as the NV2A does, instead of to nearest
    /// Other than `point` needs fetches between stages, passes with dependent reads, or
    /// double_precision.
    TableFilter table_filter = TableFilter::point;
    float table_bias = 0.0F;  ///< -8 .. 8: its steps count 2^table_bias times
    Quads quads = Quads::of_triangle;
    /// No machine: the formulas of the reflectance models in double precision (docs/models.md). Of
    /// the fields above, `viewer`, `tangent_frames`, `filter_order`, `table_filter` and
    /// `table_bias` count, and `half_vector` must be `pixel`.
    bool double_precision = false;

    /// Throws Error{bad_option} for a field outside its range, for a choice of the nine-bit model
    /// on a wide machine, and with double_precision for half vectors other than per pixel.
    void validate() const;

    friend bool operator==(const Machine&, const Machine&) = default;

    /// What is left for programs: a cube map for half vectors has one of the texture units, and
    /// they know nothing of the filter order.
    [[nodiscard]] Machine for_programs() const;
};

/// Sets half_vector from "pixel", "vertex" or "cube:N", and its size from N.
/// Throws Error{bad_option} for anything else.
void choose_half_vector(Machine& machine, std::string_view word);

/// "before" or "after". Throws Error{bad_option} for anything else.
FilterOrder filter_order_of(std::string_view word);

/// The names that `machine_profile` knows: machines in order of age, then "double".
std::vector<std::string_view> machine_profile_names();

/// "geforce256", "nv2a", "ideal" or "double". Throws Error{bad_option} for another name.
Machine machine_profile(std::string_view name);

}  // namespace burnish
