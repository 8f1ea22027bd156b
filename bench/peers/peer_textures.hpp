#pragma once

#include <burnish/scene.hpp>
#include <burnish/texture.hpp>
#include <utility>

/// Textures of the comparison that materials do not bring: RGBA, 8 bits, repeated, bilinear.
namespace burnish::peers {

/// Colours of the vertices of `Shading::textured`: base + tint max(0, n.l); and of `flat`.
inline constexpr glm::vec3 kLitTint{0.75F, 0.6F, 0.45F}, kLitBase{0.25F, 0.2F, 0.15F};
inline constexpr glm::vec3 kFlatColor{0.2F, 0.6F, 0.8F};

/// Texels of level 0 as an image; of textures with four unsigned bytes.
Image8 texels_of(const Texture& texture, std::size_t level = 0);

/// The same with colours scaled until the largest is 255.
TexturePtr brightened(const Texture& texture);

/// The same with an alpha of 255.
TexturePtr opaque(const Texture& texture);

/// The same texels with all levels of a box filter, filtered trilinearly.
TexturePtr with_mipmaps(const Texture& texture);

/// The same colours, with an alpha that waves once around 0 .. 1 over the texture.
TexturePtr with_alpha_waves(const Texture& texture);

/// A pattern in all four channels.
TexturePtr stripes_with_alpha();

/// s^(N/2) in all channels: s of 0 .. 1 along s, N from `low` to `high` along t, 256 x 256 texels,
/// the first and the last the ends.
TexturePtr power_table(float low, float high);

/// The layer of `material` on `ideal` in bytes. The tangent is coded n * 127.5 + 128.
TexturePtr tangent_bytes(const Material& material);
/// ks times the height of Ward's lobe, and the number that 255 stands for.
std::pair<TexturePtr, float> specular_bytes(const Material& material);

}  // namespace burnish::peers
