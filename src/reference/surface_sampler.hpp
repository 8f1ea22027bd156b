#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "models/layer.hpp"
#include "models/texel.hpp"
#include "reference/level_of_detail.hpp"
#include "reference/surface.hpp"

namespace burnish::reference {

/// `components` channels from `channel` on, each over its largest code, weighted in double
/// precision.
glm::dvec3 sample_texture(const Texture& texture, const glm::dvec2& uv, int channel, int components,
                          const CoordinateSteps& steps = {});

/// A quantity of a machine's layer; a number in all three components.
glm::dvec3 layer_value(const LayerQuantity& quantity, const glm::dvec2& uv,
                       const CoordinateSteps& steps = {});

/// Texel coordinates as they are, or in the steps of 1/256 texel that machines have, downwards.
enum class TexelSteps { exact, machine };

/// The texels of a material's finest map, at which a filter after shading shades.
struct TexelGrid {
    std::vector<glm::ivec2> sizes;  ///< of its levels, in texels
    Sampler sampler;
    TexelSteps steps;  ///< of the coordinates that weights come from

    [[nodiscard]] LevelsSeen levels(const CoordinateSteps& seen) const;
    [[nodiscard]] glm::dvec2 coordinate(const glm::dvec2& uv, int level) const;
    /// Steps with which level `level` and no other is seen.
    [[nodiscard]] CoordinateSteps steps_of(int level) const;
};

/// A material at any point of its maps. Either kind filters quantities, not the maps they come
/// from; levels are those of Material::mipmaps, without it level 0 alone.
class SurfaceSampler {
  public:
    virtual ~SurfaceSampler() = default;
    [[nodiscard]] virtual Surface at(const glm::dvec2& uv,
                                     const CoordinateSteps& steps = {}) const = 0;
};

/// Quantities in double precision, computed from the maps texel by texel. A border has the colour
/// of the edge. Throws what TexelSource throws.
/// @param stop  as TexelSource has it
std::unique_ptr<SurfaceSampler> exact_surface(const Material& material,
                                              const std::function<bool()>& stop = {});

/// Quantities as they stand in the textures of a machine's layer; those that it does without are
/// exact.
std::unique_ptr<SurfaceSampler> layer_surface(const Material& material,
                                              std::span<const LayerQuantity> layer,
                                              TexelSteps steps = TexelSteps::exact);

}  // namespace burnish::reference
