#pragma once

#include <burnish/scene.hpp>
#include <glm/glm.hpp>
#include <vector>

#include "models/compile_model.hpp"

namespace burnish {

/// Maps that were made from a material's other maps, kept while the material is drawn again.
class DerivedMaps {
  public:
    /// The frame's axis `axis` (0 tangent, 1 bitangent) at every texel of the normal map, times
    /// `factor`, coded like a normal. Without a normal map: one texel with the undisturbed axis.
    TexturePtr axis_map(const TexturePtr& normal_map, int axis, float factor);

    /// Models that compile_model made.
    CompiledModels models;

    /// Forgets what was not asked for since the last call but `frames` - 1.
    void drop_unused(int frames = 1);

  private:
    struct Entry {
        TexturePtr normal_map;
        int axis;
        float factor;
        TexturePtr map;
        int idle;  ///< calls of drop_unused since it was asked for
    };
    std::vector<Entry> m_entries;
};

/// Whether maps of the talk's model are what is drawn, past compile_model: they were made for it
/// and are its material layer.
bool has_own_maps(const Material& material);

/// The modified anisotropic Blinn-Phong model of Kautz and Seidel's talk,
///   (1 - (h.t / alpha_x)^2 - (h.b / alpha_y)^2) ks light n.l + (kd light n.l + ambient),
/// as a combiner program: both dots in stage 0, squares and their sum in stage 1, E*F and the final
/// combiner for the rest; with four stages or more, ks map, diffuse term and ambient light get
/// stages of their own.
/// @param light  colour times intensity
/// Throws Error{bad_program} that names the resource that `machine` is short of.
ProgramMaterial compile_abp_modified(const Material& material, const Machine& machine,
                                     const glm::vec3& light, const glm::vec3& ambient,
                                     DerivedMaps& maps);

}  // namespace burnish
