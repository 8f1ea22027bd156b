#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/machine.hpp>
#include <burnish/texture.hpp>

/// What the texture units do before the combiners run, as data. Semantics: NV_texture_shader,
/// NV_texture_shader2, NV_texture_shader3, and one mode that only the NV2A has.
///
/// In the formulas (s, t, r, q) are the coordinates that the unit's interpolator delivers; T(...)
/// samples the unit's own texture; "previous" is the unfiltered-type texel of the unit
/// `TextureUnit::previous`; p[i] is what unit i's dot product gave.
namespace burnish {

/// Every result is (0, 0, 0, 0) where no other is named.
enum class TextureOperation : std::uint8_t {
    none,
    // By interpolated coordinates alone.
    texture_1d,         ///< T(s/q)
    texture_2d,         ///< T(s/q, t/q)
    texture_3d,         ///< T(s/q, t/q, r/q)
    texture_rectangle,  ///< T(s/q, t/q), in texels
    texture_cube_map,   ///< T(s, t, r)
    pass_through,       ///< s, t, r, q clamped to [0, 1] as r, g, b, a
    cull_fragment,      ///< drops the fragment unless s, t, r, q pass `cull` each
    // Offsets: (ds, dt) of the previous texel, through `offset_matrix`, added to coordinates.
    offset_2d,               ///< T(s + os, t + ot)
    offset_2d_scale,         ///< rgb times clamp(offset_bias + offset_scale * mag, 0, 1)
    offset_rectangle,        ///< in texels
    offset_rectangle_scale,  ///< in texels, scaled
    offset_projective_2d,    ///< T(s/q + os, t/q + ot)
    offset_projective_2d_scale,
    offset_projective_rectangle,
    offset_projective_rectangle_scale,
    offset_hilo_2d,  ///< the signed hi and lo of the previous texel instead of ds and dt
    offset_hilo_rectangle,
    offset_hilo_projective_2d,
    offset_hilo_projective_rectangle,
    // The previous texel as coordinates.
    dependent_ar,            ///< T(a, r)
    dependent_gb,            ///< T(g, b)
    dependent_hilo,          ///< T(hi, lo)
    dependent_rgb_3d,        ///< T(r, g, b)
    dependent_rgb_cube_map,  ///< T(2r - 1, 2g - 1, 2b - 1)
    // p = (s, t, r) . v(previous), through `dot_mapping`; the last unit of a group acts.
    dot_product,
    dot_product_1d,                          ///< T(p[i])
    dot_product_2d,                          ///< T(p[i-1], p[i])
    dot_product_rectangle,                   ///< T(p[i-1], p[i]), in texels
    dot_product_3d,                          ///< T(p[i-2], p[i-1], p[i])
    dot_product_cube_map,                    ///< T(p[i-2], p[i-1], p[i])
    dot_product_diffuse_cube_map,            ///< T(p[i-1], p[i], p[i+1]); unit i + 1 reflects
    dot_product_reflect_cube_map,            ///< T(E mirrored at N = p[i-2 .. i]), E = q[i-2 .. i]
    dot_product_const_eye_reflect_cube_map,  ///< the same with E = const_eye
    dot_product_pass_through,                ///< clamp(p[i], 0, 1) in all four
    dot_product_depth_replace,               ///< window depth = p[i-1] / p[i]
    dot_product_affine_depth_replace,        ///< window depth = p[i]
    // NV2A only.
    texture_brdf,  ///< T3D(lo[i-2], lo[i-1], hi[i-2] - hi[i-1] modulo 1): HILO texels (phi, sigma)
};
inline constexpr int kTextureOperationCount = static_cast<int>(TextureOperation::texture_brdf) + 1;

/// The operation's identifier above; "unknown operation" outside the enumeration.
std::string_view texture_operation_name(TextureOperation operation);

/// Whether it reads the texel of TextureUnit::previous.
bool reads_previous(TextureOperation operation);

/// Whether it gives the fragment another depth, which one unit may do.
bool replaces_depth(TextureOperation operation);

/// How a dot product reads the previous texel. The first three are OpenGL's, for unsigned texels;
/// signed and HILO texels are then taken as their format says. The others are codes of the NV2A,
/// for nine-bit machines with texture shaders; x is the byte, n the same in two's complement.
enum class DotMapping : std::uint8_t {
    unsigned_identity,       ///< hardware code 0
    expand,                  ///< 2c - 1
    force_blue_to_one,       ///< (r, g, 1) (NV_texture_shader3)
    nv2a_d3d,                ///< code 1: (x - 128) / 127
    nv2a_gl,                 ///< code 2: (n + 1/2) / 127.5
    nv2a_signed,             ///< code 3: n / 127
    nv2a_hilo,               ///< code 4: (hi, lo, 1) of an unsigned HILO texel
    nv2a_hemisphere_d3d,     ///< code 5: hi, lo as code 1 in 16 bits, sqrt(1 - hi^2 - lo^2)
    nv2a_hemisphere_gl,      ///< code 6: likewise by code 2, of a signed HILO texel
    nv2a_hemisphere_signed,  ///< code 7: likewise by code 3, of a signed HILO texel
};

/// What the offset operations take from the texel of another unit.
enum class BumpSource : std::uint8_t {
    dsdt,   ///< ds, dt and the magnitude of a DSDT texture, as OpenGL has it
    rgba8,  ///< NV2A: blue and green of any 8-bit texel, two's complement / 128; magnitude: red
};

enum class CullTest : std::uint8_t {
    greater_or_equal_zero,
    less_than_zero,
};

/// A field that the operation has no use for keeps its initial value, which is OpenGL's.
struct TextureUnit {
    TextureOperation operation = TextureOperation::none;
    int previous = 0;  ///< below this unit's own number
    DotMapping dot_mapping = DotMapping::unsigned_identity;
    /// (os, ot) = offset_matrix * (ds, dt); GLM and OpenGL alike keep it column by column.
    glm::mat2 offset_matrix{1.0F};
    float offset_scale = 1.0F;
    float offset_bias = 0.0F;
    glm::vec3 const_eye{0.0F, 0.0F, -1.0F};
    std::array<CullTest, 4> cull{};  ///< of s, t, r, q

    friend bool operator==(const TextureUnit&, const TextureUnit&) = default;
};

inline constexpr int kTextureShaderUnits = 4;

struct TextureShader {
    std::array<TextureUnit, kTextureShaderUnits> units;
    BumpSource bump_source = BumpSource::dsdt;

    /// Throws Error{bad_program} for what `machine` cannot run: operations that it lacks, units
    /// beyond its number, a previous unit that is not an earlier one, depth replaced twice. Rules
    /// that depend on textures are those of check_consistency.
    void validate(const Machine& machine) const;

    friend bool operator==(const TextureShader&, const TextureShader&) = default;
};

/// Why a unit is off.
struct UnitProblem {
    int unit;
    std::string reason;  ///< "offset_2d reads unit 0, which has a colour, expected ..."
};

/// The units that break a rule of NV_texture_shader and hence act as `none`, in order: one whose
/// texture is missing, has another target or a format that the operation or its reader cannot use;
/// one that reads a unit without a texel or one that is off itself; a dot product at a wrong place.
/// @param shader    valid for `machine`
/// @param textures  of units 0, 1, ...; missing and null ones are none
std::vector<UnitProblem> check_consistency(const TextureShader& shader,
                                           std::span<const TexturePtr> textures,
                                           const Machine& machine);

}  // namespace burnish
