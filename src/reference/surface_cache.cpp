#include "reference/surface_cache.hpp"

namespace burnish::reference {

ExactMaterial exact_material(const Material& material, const std::function<bool()>& stop) {
    if (material.model == Model::text)
        return {nullptr, std::make_shared<TextModel>(material, stop)};
    return {exact_surface(material, stop), nullptr};
}

ExactMaterial SurfaceCache::of(const std::shared_ptr<const Material>& material) {
    for (Entry& entry : m_entries) {
        if (entry.material != material) continue;
        entry.idle = 0;
        return entry.exact;
    }
    return m_entries.emplace_back(Entry{material, exact_material(*material, stop), 0}).exact;
}

void SurfaceCache::drop_unused(int frames) {
    std::erase_if(m_entries, [frames](const Entry& entry) { return entry.idle >= frames; });
    for (Entry& entry : m_entries) ++entry.idle;
}

void SurfaceCache::drop_orphans() {
    std::erase_if(m_entries, [](const Entry& entry) { return entry.material.use_count() == 1; });
}

}  // namespace burnish::reference
