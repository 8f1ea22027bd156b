#include "machine/unit_operations.hpp"

namespace burnish {

using Op = TextureOperation;

std::optional<TextureTarget> sampled_target(TextureOperation operation) {
    switch (operation) {
        case Op::texture_1d:
        case Op::dot_product_1d:
            return TextureTarget::one_d;
        case Op::texture_2d:
        case Op::offset_2d:
        case Op::offset_2d_scale:
        case Op::offset_projective_2d:
        case Op::offset_projective_2d_scale:
        case Op::offset_hilo_2d:
        case Op::offset_hilo_projective_2d:
        case Op::dependent_ar:
        case Op::dependent_gb:
        case Op::dependent_hilo:
        case Op::dot_product_2d:
            return TextureTarget::two_d;
        case Op::texture_rectangle:
        case Op::offset_rectangle:
        case Op::offset_rectangle_scale:
        case Op::offset_projective_rectangle:
        case Op::offset_projective_rectangle_scale:
        case Op::offset_hilo_rectangle:
        case Op::offset_hilo_projective_rectangle:
        case Op::dot_product_rectangle:
            return TextureTarget::rectangle;
        case Op::texture_3d:
        case Op::dependent_rgb_3d:
        case Op::dot_product_3d:
        case Op::texture_brdf:
            return TextureTarget::three_d;
        case Op::texture_cube_map:
        case Op::dependent_rgb_cube_map:
        case Op::dot_product_cube_map:
        case Op::dot_product_diffuse_cube_map:
        case Op::dot_product_reflect_cube_map:
        case Op::dot_product_const_eye_reflect_cube_map:
            return TextureTarget::cube;
        case Op::none:
        case Op::pass_through:
        case Op::cull_fragment:
        case Op::dot_product:
        case Op::dot_product_pass_through:
        case Op::dot_product_depth_replace:
        case Op::dot_product_affine_depth_replace:
            break;
    }
    return std::nullopt;
}

bool has_texel(TextureOperation operation) {
    return sampled_target(operation) || operation == Op::pass_through ||
           operation == Op::dot_product_pass_through;
}

bool takes_dot_product(TextureOperation operation) {
    return operation >= Op::dot_product && operation <= Op::dot_product_affine_depth_replace;
}

int dot_products_used(TextureOperation operation) {
    switch (operation) {
        case Op::dot_product:
        case Op::dot_product_1d:
        case Op::dot_product_pass_through:
        case Op::dot_product_affine_depth_replace:
            return 1;
        case Op::dot_product_2d:
        case Op::dot_product_rectangle:
        case Op::dot_product_diffuse_cube_map:
        case Op::dot_product_depth_replace:
            return 2;
        case Op::dot_product_3d:
        case Op::dot_product_cube_map:
        case Op::dot_product_reflect_cube_map:
        case Op::dot_product_const_eye_reflect_cube_map:
            return 3;
        default:
            return 0;
    }
}

bool is_reflection(TextureOperation operation) {
    return operation == Op::dot_product_reflect_cube_map ||
           operation == Op::dot_product_const_eye_reflect_cube_map;
}

bool is_dimmed(TextureOperation operation) {
    return operation == Op::offset_2d_scale || operation == Op::offset_rectangle_scale ||
           operation == Op::offset_projective_2d_scale ||
           operation == Op::offset_projective_rectangle_scale;
}

bool is_projective_offset(TextureOperation operation) {
    return (operation >= Op::offset_projective_2d &&
            operation <= Op::offset_projective_rectangle_scale) ||
           operation == Op::offset_hilo_projective_2d ||
           operation == Op::offset_hilo_projective_rectangle;
}

bool is_hilo_offset(TextureOperation operation) {
    return operation >= Op::offset_hilo_2d && operation <= Op::offset_hilo_projective_rectangle;
}

TextureOperation plain_operation(TextureTarget target) {
    switch (target) {
        case TextureTarget::one_d:
            return Op::texture_1d;
        case TextureTarget::two_d:
            return Op::texture_2d;
        case TextureTarget::rectangle:
            return Op::texture_rectangle;
        case TextureTarget::cube:
            return Op::texture_cube_map;
        case TextureTarget::three_d:
            return Op::texture_3d;
    }
    return Op::none;
}

}  // namespace burnish
