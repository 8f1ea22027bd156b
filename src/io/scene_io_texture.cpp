#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <cstdint>
#include <utility>

#include "core/nearest.hpp"
#include "io/image_io.hpp"
#include "io/scene_io_parts.hpp"
#include "models/brushed.hpp"

namespace burnish {
namespace {

constexpr std::array<std::pair<std::string_view, Filter>, 2> kFilters{
    {{"nearest", Filter::nearest}, {"linear", Filter::linear}}};
constexpr std::array<std::pair<std::string_view, TexelFormat>, 2> kTexelFormats{
    {{"rgba8", TexelFormat::rgba8}, {"signed_rgba8", TexelFormat::signed_rgba8}}};
constexpr std::array<std::pair<std::string_view, Wrap>, 2> kWraps{
    {{"repeat", Wrap::repeat}, {"clamp_to_edge", Wrap::clamp_to_edge}}};

using BrushedMap = Image8 BrushedMaps::*;
constexpr std::array<std::pair<std::string_view, BrushedMap>, 4> kBrushedMaps{
    {{"normal", &BrushedMaps::normal},
     {"tangent", &BrushedMaps::tangent},
     {"bitangent", &BrushedMaps::bitangent},
     {"specular", &BrushedMaps::specular}}};

/// Generated maps come in sets; each set is made once per scene.
using BrushedSets = std::map<std::pair<std::uint32_t, int>, BrushedMaps>;

Wrap wrap_named(const Section& section, const std::string& name) {
    std::vector<std::string_view> known;
    for (const auto& [word, value] : kWraps) {
        if (word == name) return value;
        known.push_back(word);
    }
    section.fail_unknown_word("wrap", name, known);
}

Sampler read_sampler(const Section& section) {
    Sampler sampler;
    sampler.filter = section.choice<Filter>("filter", kFilters).value_or(sampler.filter);
    if (const auto wraps = section.texts("wrap")) {
        if (wraps->size() != 2)
            section.fail("wrap",
                         fmt::format("'wrap' in {} has {} elements, expected 2: for s and t",
                                     section.label(), wraps->size()));
        sampler.wrap_s = wrap_named(section, (*wraps)[0]);
        sampler.wrap_t = wrap_named(section, (*wraps)[1]);
    }
    return sampler;
}

TexelFormat read_format(const Section& section) {
    for (const char* later : {"r8", "hilo16", "signed_hilo16", "dsdt8", "dsdt8_mag8",
                              "dsdt8_mag8_intensity8", "rgba16"}) {
        if (section.text("format").value_or("") == later) section.refuse({"format"});
    }
    const TexelFormat format =
        section.choice<TexelFormat>("format", kTexelFormats).value_or(TexelFormat::rgba8);
    if (format != TexelFormat::rgba8 && section.has("generator"))
        section.fail("format", fmt::format("'format' in {}, expected rgba8 for a generated map",
                                           section.label()));
    return format;
}

Image8 read_texels(const Section& section) {
    const auto width = section.integer("width", 1, Texture::kMaxSize);
    const auto height = section.integer("height", 1, Texture::kMaxSize);
    if (!width || !height)
        section.fail("texels",
                     fmt::format("'texels' in {} without a size, expected width and height",
                                 section.label()));
    const std::size_t count =
        4 * static_cast<std::size_t>(*width) * static_cast<std::size_t>(*height);
    const auto values = section.numbers("texels", count, count, {0.0, 255.0});
    // The count was checked against the file, so a huge size costs nothing.
    Image8 image(*width, *height);
    for (std::size_t i = 0; i < count; ++i) {
        const float value = (*values)[i];
        image.rgba[i] = static_cast<std::uint8_t>(value);
        if (static_cast<float>(image.rgba[i]) != value)
            section.fail("texels",
                         fmt::format("'texels' in {} has the value {}, expected an integer "
                                     "of 0 .. 255",
                                     section.label(), value));
    }
    return image;
}

NamedTexture read_generated(const Section& section, const Sampler& sampler, BrushedSets& sets) {
    const std::array<std::string_view, 1> generators{"brushed"};
    const std::string generator = section.text("generator").value();
    if (generator != generators[0]) section.fail_unknown_word("generator", generator, generators);
    const int seed = section.integer("seed", 0, std::numeric_limits<int>::max()).value_or(1);
    const int size = section.integer("width", 1, 4096).value_or(512);
    if (section.integer("height", 1, 4096).value_or(size) != size)
        section.fail("height", fmt::format("'height' in {} differs from 'width', expected a square "
                                           "for a generated map",
                                           section.label()));
    const BrushedMap map =
        section.choice<BrushedMap>("map", kBrushedMaps).value_or(&BrushedMaps::normal);
    const std::pair key{static_cast<std::uint32_t>(seed), size};
    auto set = sets.find(key);
    if (set == sets.end()) set = sets.emplace(key, brushed_maps(key.first, key.second)).first;
    const bool vectors = map == &BrushedMaps::tangent || map == &BrushedMaps::bitangent;
    return {std::make_shared<const Texture>(set->second.*map, sampler),
            vectors ? set->second.map_scale : 0.0F};
}

NamedTexture read_texture(const Section& section, const std::filesystem::path& directory,
                          BrushedSets& sets) {
    section.refuse({"mip_files"});
    section.accept_only("target", "2d");
    section.accept_only("mipmaps", "none");
    if (section.number("lod_bias").value_or(0.0F) != 0.0F) section.refuse({"lod_bias"});
    const int sources = static_cast<int>(section.has("file")) +
                        static_cast<int>(section.has("texels")) +
                        static_cast<int>(section.has("generator"));
    if (sources != 1)
        section.fail("name",
                     fmt::format("{} has {} sources of texels, expected one of file, texels, "
                                 "generator",
                                 section.label(), sources));
    const Sampler sampler = read_sampler(section);
    const TexelFormat format = read_format(section);
    if (section.has("generator")) return read_generated(section, sampler, sets);
    if (section.has("texels"))
        return {std::make_shared<const Texture>(read_texels(section), sampler, format), 0.0F};
    const std::filesystem::path file = directory / section.text("file").value();
    try {
        return {std::make_shared<const Texture>(read_image_file(file), sampler, format), 0.0F};
    } catch (const Error& error) {
        throw Error(error.code(), section.place("file") + ": " + error.what());
    }
}

}  // namespace

TextureTable read_textures(const Section& root, const std::filesystem::path& directory) {
    TextureTable textures;
    BrushedSets sets;
    for (const toml::table* table : root.tables("textures")) {
        const Section section(
            *table, "[[textures]]",
            {"name", "file", "width", "height", "texels", "generator", "seed", "map", "format",
             "target", "filter", "wrap", "mipmaps", "mip_files", "lod_bias"});
        const std::string name = section.required_text("name");
        require_new_name(section, textures, name);
        textures.emplace(name, read_texture(section, directory, sets));
    }
    return textures;
}

std::optional<NamedTexture> texture_of(const Section& section, std::string_view key,
                                       const TextureTable& textures) {
    const std::optional<std::string> name = section.text(key);
    if (!name) return std::nullopt;
    const auto found = textures.find(*name);
    if (found == textures.end())
        section.fail(
            key, fmt::format("'{}' in {} names the unknown texture '{}', {}", key, section.label(),
                             *name, expected_one_of(*name, names_of(textures))));
    return found->second;
}

}  // namespace burnish
