#include "reference/level_of_detail.hpp"

#include <algorithm>
#include <cmath>

namespace burnish::reference {

namespace {

/// A step is longer than another one from this part of it on, and not by rounding alone.
constexpr double kLonger = 1.0 / 256.0;

/// The longer step of a sample in texels of level 0, and how it is divided.
struct Extent {
    double longest = 0.0;
    int probes = 1;
    glm::dvec2 apart{0.0};
};

Extent extent_of(const CoordinateSteps& steps, const glm::dvec2& size, int max_anisotropy) {
    const auto texels = [&](const glm::dvec2& step) {
        return std::sqrt(glm::dot(step * size, step * size));
    };
    const double across = texels(steps.across), down = texels(steps.down);
    Extent extent{std::max(across, down)};
    // Magnified texels, and what is no number, need no probes.
    if (max_anisotropy <= 1 || !(extent.longest > 1.0) || !std::isfinite(extent.longest))
        return extent;
    // Steps shorter than a texel see no detail more.
    const double shortest = std::max(std::min(across, down), 1.0);
    extent.probes = static_cast<int>(std::min(std::ceil(extent.longest / shortest - kLonger),
                                              static_cast<double>(max_anisotropy)));
    extent.apart = (across > down ? steps.across : steps.down) / (extent.probes + 1.0);
    return extent;
}

LevelsSeen levels_at(double lambda, int levels, const Sampler& sampler) {
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

}  // namespace

LevelsSeen levels_seen(const CoordinateSteps& steps, int width, int height, int levels,
                       const Sampler& sampler) {
    const Extent extent = extent_of(steps, glm::dvec2(width, height), sampler.max_anisotropy);
    // No step at all, and what is no number, is level 0.
    const double lambda =
        extent.longest > 0.0 && std::isfinite(extent.longest)
            ? std::log2(extent.longest / extent.probes) + static_cast<double>(sampler.lod_bias)
            : 0.0;
    LevelsSeen seen = levels_at(lambda, levels, sampler);
    seen.probes = extent.probes;
    seen.apart = extent.apart;
    return seen;
}

}  // namespace burnish::reference
