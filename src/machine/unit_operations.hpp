#pragma once

#include <burnish/texture.hpp>
#include <burnish/texture_shader.hpp>
#include <optional>

/// What the operations of texture units have in common.
namespace burnish {

/// The target that an operation samples; nothing if it samples none.
std::optional<TextureTarget> sampled_target(TextureOperation operation);

/// Whether later units can read its texel: it samples a texture, or passes its coordinates through.
bool has_texel(TextureOperation operation);

bool takes_dot_product(TextureOperation operation);

/// How many dot products it needs, its own included: 1, 2 or 3 for those that take one, else 0. The
/// diffuse half of a pair says 2, its third is the next unit's.
int dot_products_used(TextureOperation operation);

/// One of the two that mirror an eye vector.
bool is_reflection(TextureOperation operation);

/// Whether the texel is dimmed by the magnitude of the previous one.
bool is_dimmed(TextureOperation operation);

/// Whether coordinates are divided by q before offsets are added.
bool is_projective_offset(TextureOperation operation);

/// Whether offsets are the previous texel's hi and lo.
bool is_hilo_offset(TextureOperation operation);

/// The operation of a unit without a texture shader.
TextureOperation plain_operation(TextureTarget target);

}  // namespace burnish
