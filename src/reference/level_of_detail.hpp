#pragma once

#include <algorithm>
#include <burnish/texture.hpp>
#include <glm/glm.hpp>

#include "models/texel.hpp"
#include "reference/footprint.hpp"

namespace burnish::reference {

/// How texture coordinates change from one sample to the next one to the right and below.
struct CoordinateSteps {
    glm::dvec2 across{0.0}, down{0.0};
};

/// The levels that a sample looks at, and what they are weighted with.
struct LevelsSeen {
    int first, second;      ///< first <= second
    double weight;          ///< of the second, 0 .. 1
    bool linear;            ///< within a level; else the nearest texel
    int probes = 1;         ///< places that are averaged
    glm::dvec2 apart{0.0};  ///< from one of them to the next
};

/// The level of detail is log2 of the longer step in texels of level 0, plus the sampler's bias, as
/// on the machines, with all its digits; levels are chosen from it as `sampler` says. Where it is
/// not above 0, texels are magnified.
///
/// With sampler.max_anisotropy above 1 the longer step is divided among as many probes as it holds
/// shorter ones, up to that many: N = ceil(longer / shorter - 1/256), each N-th of the longer one
/// long, at i / (N + 1) - 1/2 of it, i = 1 .. N. EXT_texture_filter_anisotropic, 1999.
LevelsSeen levels_seen(const CoordinateSteps& steps, int width, int height, int levels,
                       const Sampler& sampler);

/// Mean of texel(level, x, y) at `uv`; `size(level)` is the level's in texels.
template <class Texel, class Size>
[[nodiscard]] auto filtered(const glm::dvec2& uv, const LevelsSeen& seen, const Sampler& sampler,
                            Size&& size, Texel&& texel) {
    const auto in_level = [&](const glm::dvec2& at, int level) {
        const glm::ivec2 sides = size(level);
        return footprint(at, sides.x, sides.y, sampler, seen.linear).mean([&](int x, int y) {
            return texel(level, x, y);
        });
    };
    const auto blended = [&](const glm::dvec2& at) {
        if (seen.weight == 0.0) return in_level(at, seen.first);
        return in_level(at, seen.first) * (1.0 - seen.weight) +
               in_level(at, seen.second) * seen.weight;
    };
    const auto probe = [&](int i) {
        return blended(uv + seen.apart * (i - 0.5 * (seen.probes - 1)));
    };
    auto sum = probe(0);
    if (seen.probes == 1) return sum;
    for (int i = 1; i < seen.probes; ++i) sum = sum + probe(i);
    return sum * (1.0 / seen.probes);
}

/// Mean of value(parameters) over what a sample sees of a material. A border has the colour of the
/// edge.
template <class Value>
[[nodiscard]] auto filtered_texels(const TexelSource& source, const glm::dvec2& uv,
                                   const CoordinateSteps& steps, Value&& value) {
    const bool has_levels = source.levels() > 1;
    const LevelsSeen seen = levels_seen(has_levels ? steps : CoordinateSteps{}, source.width(),
                                        source.height(), source.levels(), source.sampler());
    const auto size = [&](int level) {
        return glm::ivec2(source.width(level), source.height(level));
    };
    return filtered(uv, seen, source.sampler(), size, [&](int level, int x, int y) {
        const glm::ivec2 last = size(level) - 1;
        return value(source.at(level, std::clamp(x, 0, last.x), std::clamp(y, 0, last.y)));
    });
}

}  // namespace burnish::reference
