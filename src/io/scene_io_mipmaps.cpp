#include <fmt/format.h>

#include <algorithm>
#include <burnish/materials.hpp>
#include <optional>
#include <string>

#include "io/scene_io_parts.hpp"

namespace burnish {
namespace {

/// Keys of a material that may name a map.
constexpr std::string_view kMapKeys[] = {"normal_map",
                                         "direction_map",
                                         "tangent_map",
                                         "bitangent_map",
                                         "specular_map",
                                         "alpha_x",
                                         "alpha_y",
                                         "exponent",
                                         "N",
                                         "kd",
                                         "ks"};

/// The texture that `key` names, itself or as `map` of its table.
const NamedTexture* map_of(const Section& section, std::string_view key,
                           const TextureTable& textures) {
    std::optional<std::string> name;
    if (section.has_text(key)) name = section.text(key);
    if (section.has_table(key))
        name = Section(*section.table(key), section.label(),
                       {"map", "channel", "low", "high", "color"})
                   .text("map");
    const auto found = name ? textures.find(*name) : textures.end();
    return found == textures.end() ? nullptr : &found->second;
}

/// What the maps ask for, all that do the same.
std::optional<MipMethod> method_of_maps(const Section& section, const TextureTable& textures) {
    std::optional<MipMethod> method;
    for (const std::string_view key : kMapKeys) {
        const NamedTexture* map = map_of(section, key, textures);
        if (map == nullptr || !map->mipmaps) continue;
        if (method && *method != *map->mipmaps)
            section.fail(key, fmt::format("'{}' in {} has other 'mipmaps' than the maps before "
                                          "it, expected one method for a material",
                                          key, section.label()));
        method = map->mipmaps;
    }
    return method;
}

}  // namespace

void read_mipmaps(const Section& section, const TextureTable& textures, Material& material) {
    std::optional<MipMethod> method;
    if (const std::optional<std::string> word = section.text("mipmaps")) {
        method = mip_method_named(*word);
        if (!method) section.fail_unknown_word("mipmaps", *word, mip_method_names());
    } else {
        method = method_of_maps(section, textures);
    }
    if (method) {
        if (!material.mipmaps) material.mipmaps.emplace();
        material.mipmaps->method = *method;
    }
    if (!material.mipmaps) {
        for (const std::string_view key : {"mipmap_bits", "max_anisotropy"})
            section.refuse_without(key, "mipmaps");
        return;
    }
    material.mipmaps->max_anisotropy = section.integer("max_anisotropy", 1, Sampler::kMostProbes)
                                           .value_or(material.mipmaps->max_anisotropy);
    const std::optional<int> bits = section.integer("mipmap_bits", 8, 32);
    if (!bits) return;
    if (*bits != 8 && *bits != 16 && *bits != 32)
        section.fail("mipmap_bits", fmt::format("'mipmap_bits' = {} in {}, expected 8, 16 or 32",
                                                *bits, section.label()));
    material.mipmaps->bits = *bits;
}

}  // namespace burnish
