#include "reference/surface_cache.hpp"

namespace burnish::reference {

ExactMaterial exact_material(const Material& material) {
    if (material.model == Model::text) return {nullptr, std::make_shared<TextModel>(material)};
    return {exact_surface(material), nullptr};
}

ExactMaterial SurfaceCache::of(const std::shared_ptr<const Material>& material) {
    for (Entry& entry : m_entries) {
        if (entry.material != material) continue;
        entry.used = true;
        return entry.exact;
    }
    return m_entries.emplace_back(Entry{material, exact_material(*material), true}).exact;
}

void SurfaceCache::drop_unused() {
    std::erase_if(m_entries, [](const Entry& entry) { return !entry.used; });
    for (Entry& entry : m_entries) entry.used = false;
}

void SurfaceCache::drop_orphans() {
    std::erase_if(m_entries, [](const Entry& entry) { return entry.material.use_count() == 1; });
}

}  // namespace burnish::reference
