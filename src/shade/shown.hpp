#pragma once

#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "kernels/kernel_table.hpp"
#include "shade/output.hpp"
#include "shade/shading.hpp"

namespace burnish {

/// What a frame shows in place of an object's colours, of fragments that passed all tests.
struct ShownValues {
    std::optional<Aov> aov;  ///< nothing: the result of the program of `values`, a register
    Shading values;          ///< what triangles interpolate for it; with an aov it has no program
    // Of aovs that show tangent frames:
    bool orthonormal = false;  ///< frames are made so at the pixel
    glm::mat3 world_from_object{1.0F};
    glm::mat4 pixels_from_object{1.0F};  ///< homogeneous, y down, the same units along x and y
};

/// @param pixels_from_world  homogeneous, see ShownValues
ShownValues shown_values(Aov aov, const Object& object, TangentFrames frames,
                         const glm::dmat4& pixels_from_world);

/// Where no fragment is.
glm::vec4 background_of(Aov aov);

/// A triangle's consecutive fragments of a packet.
struct ShownRun {
    DepthRun depth;
    std::uint32_t object, triangle;
};

/// The aov of a packet whose attributes are those of `shown.values`, to the pixels `stored`.
/// `own_depths`: the fragments' depths if they replace the triangles', else null.
void write_values(const ShownValues& shown, const Packet& packet, std::span<const ShownRun> runs,
                  const float* own_depths, const std::uint16_t* stored, const OutputTile& tile);

}  // namespace burnish
