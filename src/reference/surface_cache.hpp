#pragma once

#include <burnish/scene.hpp>
#include <functional>
#include <memory>
#include <vector>

#include "reference/surface_sampler.hpp"
#include "reference/text_model.hpp"

namespace burnish::reference {

/// A material exactly as it is; one of the two, as its model has it.
struct ExactMaterial {
    std::shared_ptr<const SurfaceSampler> surface;
    std::shared_ptr<const TextModel> text;  ///< of Model::text
};

/// `stop` as TexelSource has it. Throws what exact_surface and TextModel throw.
ExactMaterial exact_material(const Material& material, const std::function<bool()>& stop = {});

/// Exact materials, kept while they are drawn again: mip levels of parameters take a second for
/// maps of a million texels.
class SurfaceCache {
  public:
    std::function<bool()> stop;  ///< of exact_material

    /// Throws what exact_material throws.
    ExactMaterial of(const std::shared_ptr<const Material>& material);
    /// Forgets what was not asked for since the last call but `frames` - 1.
    void drop_unused(int frames = 1);
    /// Forgets materials that nobody else has: none of them can be drawn again.
    void drop_orphans();

  private:
    struct Entry {
        std::shared_ptr<const Material> material;
        ExactMaterial exact;
        int idle;  ///< calls of drop_unused since it was asked for
    };
    std::vector<Entry> m_entries;
};

}  // namespace burnish::reference
