#include <burnish/texture_shader.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <string>

namespace burnish {
namespace {

/// In the order of the enumeration.
constexpr std::array<std::string_view, kTextureOperationCount> kNames{
    "none",
    "texture_1d",
    "texture_2d",
    "texture_3d",
    "texture_rectangle",
    "texture_cube_map",
    "pass_through",
    "cull_fragment",
    "offset_2d",
    "offset_2d_scale",
    "offset_rectangle",
    "offset_rectangle_scale",
    "offset_projective_2d",
    "offset_projective_2d_scale",
    "offset_projective_rectangle",
    "offset_projective_rectangle_scale",
    "offset_hilo_2d",
    "offset_hilo_rectangle",
    "offset_hilo_projective_2d",
    "offset_hilo_projective_rectangle",
    "dependent_ar",
    "dependent_gb",
    "dependent_hilo",
    "dependent_rgb_3d",
    "dependent_rgb_cube_map",
    "dot_product",
    "dot_product_1d",
    "dot_product_2d",
    "dot_product_rectangle",
    "dot_product_3d",
    "dot_product_cube_map",
    "dot_product_diffuse_cube_map",
    "dot_product_reflect_cube_map",
    "dot_product_const_eye_reflect_cube_map",
    "dot_product_pass_through",
    "dot_product_depth_replace",
    "dot_product_affine_depth_replace",
    "texture_brdf",
};

bool is_plain(TextureOperation operation) {
    switch (operation) {
        case TextureOperation::none:
        case TextureOperation::texture_1d:
        case TextureOperation::texture_2d:
        case TextureOperation::texture_rectangle:
        case TextureOperation::texture_cube_map:
            return true;
        default:
            return false;
    }
}

/// The fourteen operations of NV_texture_shader3.
bool is_third_generation(TextureOperation operation) {
    switch (operation) {
        case TextureOperation::dependent_hilo:
        case TextureOperation::dependent_rgb_3d:
        case TextureOperation::dependent_rgb_cube_map:
        case TextureOperation::dot_product_1d:
        case TextureOperation::dot_product_pass_through:
        case TextureOperation::dot_product_affine_depth_replace:
            return true;
        default:
            return operation >= TextureOperation::offset_projective_2d &&
                   operation <= TextureOperation::offset_hilo_projective_rectangle;
    }
}

bool has(TextureOperations operations, const TextureUnit& unit) {
    switch (operations) {
        case TextureOperations::plain:
            return is_plain(unit.operation);
        case TextureOperations::nv2a:
            return !is_third_generation(unit.operation);
        case TextureOperations::all:
            break;
    }
    return true;
}

bool all_finite(const TextureUnit& unit) {
    float sum = unit.offset_scale * 0.0F + unit.offset_bias * 0.0F;
    for (int i = 0; i < 3; ++i) sum += unit.const_eye[i] * 0.0F;
    for (int i = 0; i < 4; ++i) sum += unit.offset_matrix[i / 2][i % 2] * 0.0F;
    return std::isfinite(sum);
}

/// Bytes read in ways that only the hardware has: nine-bit codes are bytes, wide ones are not.
bool has_nv2a_readings(const Machine& machine) {
    return machine.numbers == NumberModel::nine_bit &&
           machine.texture_operations != TextureOperations::plain;
}

void check_unit(int index, const TextureUnit& unit, const Machine& machine) {
    const auto fail = [index](const std::string& message) {
        throw Error(ErrorCode::bad_program, fmt::format("texture unit {}: {}", index, message));
    };
    if (unit.operation == TextureOperation::none) return;
    if (static_cast<int>(unit.operation) >= kTextureOperationCount) fail("an unknown operation");
    if (index >= machine.texture_units)
        fail(fmt::format("is used, machine '{}' has texture units 0 .. {}", machine.name,
                         machine.texture_units - 1));
    if (!has(machine.texture_operations, unit))
        fail(fmt::format("machine '{}' does not have {}", machine.name,
                         texture_operation_name(unit.operation)));
    if (unit.dot_mapping == DotMapping::force_blue_to_one &&
        machine.texture_operations != TextureOperations::all)
        fail(fmt::format("machine '{}' does not have force_blue_to_one", machine.name));
    if (unit.dot_mapping >= DotMapping::nv2a_d3d && !has_nv2a_readings(machine))
        fail(fmt::format("a dot mapping of the NV2A, which machine '{}' does not have",
                         machine.name));
    if (reads_previous(unit.operation) && (unit.previous < 0 || unit.previous >= index))
        fail(fmt::format("reads unit {}, expected an earlier one", unit.previous));
    if (!all_finite(unit)) fail("a parameter is not a finite number");
}

}  // namespace

std::string_view texture_operation_name(TextureOperation operation) {
    const auto index = static_cast<std::size_t>(operation);
    return index < kNames.size() ? kNames[index] : "unknown operation";
}

bool reads_previous(TextureOperation operation) {
    return operation >= TextureOperation::offset_2d &&
           operation <= TextureOperation::dot_product_affine_depth_replace;
}

bool replaces_depth(TextureOperation operation) {
    return operation == TextureOperation::dot_product_depth_replace ||
           operation == TextureOperation::dot_product_affine_depth_replace;
}

void TextureShader::validate(const Machine& machine) const {
    if (bump_source == BumpSource::rgba8 && !has_nv2a_readings(machine))
        throw Error(ErrorCode::bad_program,
                    fmt::format("bump_source rgba8 is a mode of the NV2A, which machine '{}' does "
                                "not have",
                                machine.name));
    for (int i = 0; i < kTextureShaderUnits; ++i)
        check_unit(i, units[static_cast<std::size_t>(i)], machine);
    const auto depths = std::count_if(units.begin(), units.end(), [](const TextureUnit& unit) {
        return replaces_depth(unit.operation);
    });
    if (depths > 1) throw Error(ErrorCode::bad_program, "two texture units replace the depth");
}

}  // namespace burnish
