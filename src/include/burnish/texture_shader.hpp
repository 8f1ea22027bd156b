#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string_view>

#include <burnish/machine.hpp>

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
    texture_brdf,  ///< T3D(sigma of unit i-2, sigma of unit i-1, difference of their phi)
};
inline constexpr int kTextureOperationCount = static_cast<int>(TextureOperation::texture_brdf) + 1;

/// The operation's identifier above; "unknown operation" outside the enumeration.
std::string_view texture_operation_name(TextureOperation operation);

/// Whether it reads the texel of TextureUnit::previous.
bool reads_previous(TextureOperation operation);

/// Whether it gives the fragment another depth, which one unit may do.
bool replaces_depth(TextureOperation operation);

/// How a dot product reads an unsigned previous texel; signed texels are taken as they are.
enum class DotMapping : std::uint8_t {
    unsigned_identity,
    expand,             ///< 2c - 1
    force_blue_to_one,  ///< (r, g, 1) (NV_texture_shader3)
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

    /// Throws Error{bad_program} for what `machine` cannot run: operations that it lacks, units
    /// beyond its number, a previous unit that is not an earlier one, depth replaced twice. Rules
    /// that depend on the formats of textures are not checked here.
    void validate(const Machine& machine) const;

    friend bool operator==(const TextureShader&, const TextureShader&) = default;
};

}  // namespace burnish
