#include "reference/level_of_detail.hpp"

#include <algorithm>
#include <cmath>

namespace burnish::reference {

LevelsSeen levels_seen(const CoordinateSteps& steps, int width, int height, int levels,
                       const Sampler& sampler) {
    const auto squared_texels = [&](const glm::dvec2& step) {
        const glm::dvec2 texels = step * glm::dvec2(width, height);
        return glm::dot(texels, texels);
    };
    const double longest = std::max(squared_texels(steps.across), squared_texels(steps.down));
    // No step at all, and what is no number, is level 0.
    const double lambda = longest > 0.0 && std::isfinite(longest)
                              ? 0.5 * std::log2(longest) + static_cast<double>(sampler.lod_bias)
                              : 0.0;
    if (!(lambda > 0.0)) return {0, 0, 0.0, sampler.mag_is_linear()};
    const bool linear = is_linear_within(sampler.filter);
    const int last = levels - 1;
    const double level = std::min(lambda, static_cast<double>(last));
    switch (sampler.filter) {
        case Filter::nearest:
        case Filter::linear:
            return {0, 0, 0.0, linear};
        case Filter::nearest_mipmap_nearest:
        case Filter::linear_mipmap_nearest: {
            const int nearest = static_cast<int>(std::ceil(level - 0.5));
            return {nearest, nearest, 0.0, linear};
        }
        case Filter::nearest_mipmap_linear:
        case Filter::linear_mipmap_linear:
            break;
    }
    const int first = static_cast<int>(level);
    return {first, std::min(first + 1, last), level - first, linear};
}

}  // namespace burnish::reference
