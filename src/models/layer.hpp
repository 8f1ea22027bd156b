#pragma once

#include <burnish/machine.hpp>
#include <burnish/scene.hpp>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace burnish {

/// One quantity of the material layer: what a texel of the material's maps has to say to the
/// parameter stage. Whoever filters, filters this.
struct LayerQuantity {
    std::string name;
    std::string definition;  ///< in the language of models, from the material's parameters
    int components = 1;      ///< 1: a scalar, 3: a vector or a colour
    TexturePtr texture;      ///< null: the same everywhere
    int channel = 0;         ///< the first one in the texture
    /// value = scale * x + offset, 2 to that power if `logarithmic`, for x the filtered code over
    /// the format's largest, 255 or 65535.
    glm::dvec3 scale{1.0}, offset{0.0};
    bool logarithmic = false;
    glm::dvec3 constant{0.0};  ///< the value, without a texture

    [[nodiscard]] glm::dvec3 decoded(const glm::dvec3& x) const;
};

/// The material layer that `machine` works from, texel for texel: its precision and its scales; of
/// a machine in double precision that of the profile `ideal`.
/// Throws what compile_model throws.
std::vector<LayerQuantity> material_layer(const Material& material, const Machine& machine);

}  // namespace burnish
