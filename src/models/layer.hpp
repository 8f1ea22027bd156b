#pragma once

#include <burnish/scene.hpp>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace burnish {

/// One quantity of the material layer: a constant, or a texture that holds it coded.
struct LayerQuantity {
    std::string name;
    int components = 1;  ///< 1 or 3
    TexturePtr texture;  ///< null: constant everywhere
    int channel = 0;     ///< first channel
    glm::dvec3 scale{1},
        offset{0};           ///< value = scale * (code / max code) + offset, max code 255 or 65535
    glm::dvec3 constant{0};  ///< without a texture
};

enum class LayerFormat { bytes, words };

/// for the machine's format: 8-bit (nine_bit machines) or 16-bit texels (wide machines and double)
std::vector<LayerQuantity> material_layer(const Material& material, LayerFormat format);

}  // namespace burnish
