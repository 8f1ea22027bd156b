#pragma once

#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <glm/glm.hpp>

#include "kernels/kernel_table.hpp"
#include "shade/output.hpp"
#include "shade/shading.hpp"

namespace burnish {

/// Values of an object's geometry that a frame shows in place of its colours.
struct ShownValues {
    Aov aov;
    Shading values;  ///< what triangles interpolate for it; it has no program
};

ShownValues shown_values(Aov aov, const Object& object);

/// Where no fragment is.
glm::vec4 background_of(Aov aov);

/// A triangle's consecutive fragments of a packet.
struct ShownRun {
    DepthRun depth;
    std::uint32_t object, triangle;
};

/// Values of a packet whose attributes are those of `shown.values`, to the pixels `stored`.
/// `own_depths`: the fragments' depths if they replace the triangles', else null.
void write_values(const ShownValues& shown, const Packet& packet, std::span<const ShownRun> runs,
                  const float* own_depths, const std::uint16_t* stored, const OutputTile& tile);

}  // namespace burnish
