#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/nearest.hpp"
#include "io/image_io.hpp"
#include "io/scene_io_parts.hpp"
#include "models/generators/brushed.hpp"

namespace burnish {
namespace {

constexpr std::array<std::pair<std::string_view, Filter>, 6> kFilters{
    {{"nearest", Filter::nearest},
     {"linear", Filter::linear},
     {"nearest_mipmap_nearest", Filter::nearest_mipmap_nearest},
     {"linear_mipmap_nearest", Filter::linear_mipmap_nearest},
     {"nearest_mipmap_linear", Filter::nearest_mipmap_linear},
     {"linear_mipmap_linear", Filter::linear_mipmap_linear}}};
constexpr Names<Filter> kMagFilters(kFilters.data(), 2);
constexpr std::array<std::pair<std::string_view, TexelFormat>, 22> kTexelFormats{
    {{"rgba8", TexelFormat::rgba8},
     {"rgb8", TexelFormat::rgb8},
     {"luminance8", TexelFormat::luminance8},
     {"luminance8_alpha8", TexelFormat::luminance8_alpha8},
     {"intensity8", TexelFormat::intensity8},
     {"alpha8", TexelFormat::alpha8},
     {"r8", TexelFormat::r8},
     {"signed_rgba8", TexelFormat::signed_rgba8},
     {"signed_rgb8", TexelFormat::signed_rgb8},
     {"signed_rgb8_unsigned_alpha8", TexelFormat::signed_rgb8_unsigned_alpha8},
     {"signed_luminance8", TexelFormat::signed_luminance8},
     {"signed_luminance8_alpha8", TexelFormat::signed_luminance8_alpha8},
     {"signed_intensity8", TexelFormat::signed_intensity8},
     {"signed_alpha8", TexelFormat::signed_alpha8},
     {"hilo16", TexelFormat::hilo16},
     {"signed_hilo16", TexelFormat::signed_hilo16},
     {"hilo8", TexelFormat::hilo8},
     {"signed_hilo8", TexelFormat::signed_hilo8},
     {"dsdt8", TexelFormat::dsdt8},
     {"dsdt8_mag8", TexelFormat::dsdt8_mag8},
     {"dsdt8_mag8_intensity8", TexelFormat::dsdt8_mag8_intensity8},
     {"rgba16", TexelFormat::rgba16}}};
constexpr std::array<std::pair<std::string_view, TextureTarget>, 5> kTargets{
    {{"2d", TextureTarget::two_d},
     {"1d", TextureTarget::one_d},
     {"rectangle", TextureTarget::rectangle},
     {"cube", TextureTarget::cube},
     {"3d", TextureTarget::three_d}}};
constexpr std::array<std::pair<std::string_view, Wrap>, 4> kWraps{
    {{"repeat", Wrap::repeat},
     {"clamp_to_edge", Wrap::clamp_to_edge},
     {"clamp_to_border", Wrap::clamp_to_border},
     {"mirrored_repeat", Wrap::mirrored_repeat}}};

enum class MipmapSource { none, box, files };

using BrushedMap = Image8 BrushedMaps::*;
constexpr std::array<std::pair<std::string_view, BrushedMap>, 4> kBrushedMaps{
    {{"normal", &BrushedMaps::normal},
     {"tangent", &BrushedMaps::tangent},
     {"bitangent", &BrushedMaps::bitangent},
     {"specular", &BrushedMaps::specular}}};

using SetMap = Image8 GeneratedSet::*;
constexpr std::array<std::pair<std::string_view, SetMap>, 5> kSetMaps{
    {{"normal", &GeneratedSet::normal_map},
     {"direction", &GeneratedSet::direction_map},
     {"alpha", &GeneratedSet::alpha_map},
     {"kd", &GeneratedSet::kd_map},
     {"ks", &GeneratedSet::ks_map}}};

/// Generated maps come in sets; each set is made once per scene.
struct GeneratedSets {
    std::map<SetKey, BrushedMaps> brushed;
    std::map<std::pair<std::string, SetKey>, GeneratedSet> others;
};

Wrap wrap_named(const Section& section, const std::string& name) {
    std::vector<std::string_view> known;
    for (const auto& [word, value] : kWraps) {
        if (word == name) return value;
        known.push_back(word);
    }
    section.fail_unknown_word("wrap", name, known);
}

Sampler read_sampler(const Section& section, TextureTarget target) {
    Sampler sampler;
    if (target == TextureTarget::rectangle) sampler.wrap_s = sampler.wrap_t = Wrap::clamp_to_edge;
    sampler.filter = section.choice<Filter>("filter", kFilters).value_or(sampler.filter);
    sampler.mag_filter = section.choice<Filter>("mag_filter", kMagFilters);
    sampler.lod_bias = section.number("lod_bias", {-16.0, 15.99609375}).value_or(0.0F);
    sampler.max_anisotropy = section.integer("max_anisotropy", 1, Sampler::kMostProbes).value_or(1);
    if (sampler.max_anisotropy > 1 && target != TextureTarget::two_d)
        section.fail("max_anisotropy",
                     fmt::format("'max_anisotropy' in {} whose target is not 2d", section.label()));
    if (const auto border = section.vec4("border_color", {-1.0, 1.0}))
        sampler.border = {border->r, border->g, border->b, border->a};
    if (target == TextureTarget::cube && section.has("wrap"))
        section.fail("wrap", fmt::format("'wrap' in {} of a cube map, whose faces end at their "
                                         "edges, expected none",
                                         section.label()));
    if (const auto wraps = section.texts("wrap")) {
        const std::size_t count = target == TextureTarget::one_d     ? 1
                                  : target == TextureTarget::three_d ? 3
                                                                     : 2;
        if (wraps->size() != count && !(count == 1 && wraps->size() == 2))
            section.fail("wrap", fmt::format("'wrap' in {} has {} elements, expected {}: for {}",
                                             section.label(), wraps->size(), count,
                                             count == 3   ? "s, t and r"
                                             : count == 2 ? "s and t"
                                                          : "s"));
        Wrap* const to[] = {&sampler.wrap_s, &sampler.wrap_t, &sampler.wrap_r};
        for (std::size_t k = 0; k < wraps->size(); ++k) *to[k] = wrap_named(section, (*wraps)[k]);
    }
    return sampler;
}

/// Sides of a level.
struct LevelSize {
    int width, height, layers;
};

/// How many images each level has, down to a single texel.
std::vector<LevelSize> chain_of(LevelSize size, TextureTarget target) {
    std::vector<LevelSize> chain{size};
    const bool slices = target == TextureTarget::three_d;
    while (size.width > 1 || size.height > 1 || (slices && size.layers > 1)) {
        size.width = std::max(size.width / 2, 1);
        size.height = std::max(size.height / 2, 1);
        if (slices) size.layers = std::max(size.layers / 2, 1);
        chain.push_back(size);
    }
    return chain;
}

/// Images from the numbers of a scene: faces or slices one after the other.
template <class Image>
std::vector<Image> read_texels(const Section& section, int layers, bool is_one_d) {
    using Value = typename decltype(Image::rgba)::value_type;
    const auto width = section.integer("width", 1, Texture::kMaxSize);
    const auto given_height = section.integer("height", 1, Texture::kMaxSize);
    const std::optional<int> height = is_one_d ? given_height.value_or(1) : given_height;
    if (!width || !height)
        section.fail("texels",
                     fmt::format("'texels' in {} without a size, expected width and height",
                                 section.label()));
    const std::size_t count =
        4 * static_cast<std::size_t>(*width) * static_cast<std::size_t>(*height);
    const std::size_t all = count * static_cast<std::size_t>(layers);
    constexpr int kHighest = std::numeric_limits<Value>::max();
    const auto values = section.numbers("texels", all, all, {0.0, kHighest});
    // The count was checked against the file, so a huge size costs nothing.
    std::vector<Image> images(static_cast<std::size_t>(layers), Image(*width, *height));
    for (std::size_t i = 0; i < all; ++i) {
        const float value = (*values)[i];
        const auto code = static_cast<Value>(value);
        images[i / count].rgba[i % count] = code;
        if (static_cast<float>(code) != value)
            section.fail("texels",
                         fmt::format("'texels' in {} has the value {}, expected an integer "
                                     "of 0 .. {}",
                                     section.label(), value, kHighest));
    }
    return images;
}

void read_file(const std::filesystem::path& path, Image8& image) {
    image = read_image_file(path);
}
void read_file(const std::filesystem::path& path, Image16& image) {
    image = read_image16_file(path);
}

/// Reads the files that `key` names.
template <class Image>
void read_files(const Section& section, std::string_view key, const std::vector<std::string>& names,
                const std::filesystem::path& directory, std::vector<Image>& images) {
    for (const std::string& name : names) {
        try {
            read_file(directory / name, images.emplace_back());
        } catch (const Error& error) {
            throw Error(error.code(), section.place(key) + ": " + error.what());
        }
    }
}

void require_count(const Section& section, std::string_view key, std::size_t found,
                   std::size_t expected, std::string_view of_what) {
    if (found != expected)
        section.fail(key, fmt::format("'{}' in {} names {} files, expected {}: {}", key,
                                      section.label(), found, expected, of_what));
}

/// Level 0 from the key that brings it.
template <class Image>
std::vector<Image> read_base(const Section& section, const TextureDescription& description,
                             const std::filesystem::path& directory) {
    const bool cube = description.target == TextureTarget::cube;
    const int layers = cube ? 6 : description.depth;
    if (section.has("texels"))
        return read_texels<Image>(section, layers, description.target == TextureTarget::one_d);
    std::vector<Image> images;
    if (section.has("files")) {
        const std::vector<std::string> names = section.texts("files").value();
        require_count(section, "files", names.size(), static_cast<std::size_t>(layers),
                      cube ? "faces +x -x +y -y +z -z" : "one for every slice");
        read_files(section, "files", names, directory, images);
    } else {
        if (layers != 1)
            section.fail("file", fmt::format("'file' in {} with {} {}, expected 'files'",
                                             section.label(), layers, cube ? "faces" : "slices"));
        read_files(section, "file", {section.text("file").value()}, directory, images);
    }
    return images;
}

template <class Image>
NamedTexture read_images(const Section& section, TextureDescription description,
                         MipmapSource mipmaps, const std::filesystem::path& directory) {
    std::vector<Image> images = read_base<Image>(section, description, directory);
    description.box_mipmaps = mipmaps == MipmapSource::box;
    if (mipmaps == MipmapSource::files) {
        const std::vector<std::string> names = section.texts("mip_files").value();
        const std::vector<LevelSize> chain =
            chain_of({images.front().width, images.front().height,
                      description.target == TextureTarget::cube ? 6 : description.depth},
                     description.target);
        // A chain may stop early, but only after a whole level.
        std::size_t whole = 0, level = 1;
        while (level < chain.size() && whole < names.size())
            whole += static_cast<std::size_t>(chain[level++].layers);
        require_count(section, "mip_files", names.size(), whole, "whole levels, 1 first");
        read_files(section, "mip_files", names, directory, images);
    }
    try {
        return {std::make_shared<const Texture>(std::span<const Image>(images), description), 0.0F};
    } catch (const Error& error) {
        throw Error(error.code(), section.place("name") + ": " + error.what());
    }
}

NamedTexture read_brushed(const Section& section, const TextureDescription& description,
                          GeneratedSets& sets) {
    const BrushedMap map =
        section.choice<BrushedMap>("map", kBrushedMaps).value_or(&BrushedMaps::normal);
    const SetKey key = read_set_key(section, 4096);
    auto set = sets.brushed.find(key);
    if (set == sets.brushed.end())
        set = sets.brushed.emplace(key, brushed_maps(key.seed, key.size)).first;
    const bool vectors = map == &BrushedMaps::tangent || map == &BrushedMaps::bitangent;
    return {std::make_shared<const Texture>(std::span(&(set->second.*map), 1), description),
            vectors ? set->second.map_scale : 0.0F};
}

NamedTexture read_generated(const Section& section, TextureDescription description,
                            MipmapSource mipmaps, GeneratedSets& sets) {
    const auto only = [&](bool fits, const char* key, const char* expected) {
        if (!fits)
            section.fail(key, fmt::format("'{}' in {}, expected {} for a generated map", key,
                                          section.label(), expected));
    };
    only(description.format == TexelFormat::rgba8, "format", "rgba8");
    only(description.target == TextureTarget::two_d, "target", "2d");
    only(mipmaps != MipmapSource::files, "mipmaps", "a method");
    description.box_mipmaps = mipmaps == MipmapSource::box;
    const std::string generator = section.text("generator").value();
    // Two of the default picture's maps have no counterpart in other sets, and "normal" is as old.
    const std::string map_name = section.text("map").value_or("normal");
    const bool of_every_set = std::any_of(kSetMaps.begin() + 1, kSetMaps.end(),
                                          [&](const auto& m) { return m.first == map_name; });
    if (generator == "brushed" && !of_every_set) return read_brushed(section, description, sets);
    const std::vector<std::string_view> known = generated_set_names();
    if (std::find(known.begin(), known.end(), generator) == known.end())
        section.fail_unknown_word("generator", generator, known);
    const SetMap map = section.choice<SetMap>("map", kSetMaps).value_or(&GeneratedSet::normal_map);
    const std::pair key{generator, read_set_key(section, kMaxGeneratedSize)};
    auto set = sets.others.find(key);
    if (set == sets.others.end())
        set = sets.others.emplace(key, generated_set(generator, key.second.seed, key.second.size))
                  .first;
    const GeneratedSet& s = set->second;
    NamedTexture named{std::make_shared<const Texture>(std::span(&(s.*map), 1), description)};
    if (map == &GeneratedSet::alpha_map)
        named.ranges = {s.alpha_x_range, s.alpha_y_range, s.exponent_range};
    return named;
}

/// Where the texture's own levels come from, and what it asks of its materials.
struct Mipmaps {
    MipmapSource source = MipmapSource::none;
    std::optional<MipMethod> of_materials{};
};

Mipmaps mipmaps_of(const Section& section) {
    const std::string word = section.text("mipmaps").value_or("none");
    if ((word == "files") != section.has("mip_files"))
        section.fail("mip_files", fmt::format("'mip_files' and mipmaps = \"files\" in {} go "
                                              "together, expected both or neither",
                                              section.label()));
    if (word == "files") return {MipmapSource::files};
    const std::optional<MipMethod> method = mip_method_named(word);
    if (!method || *method == MipMethod::maps) {
        std::vector<std::string_view> known = mip_method_names();
        std::erase(known, "maps");
        known.emplace_back("files");
        section.fail_unknown_word("mipmaps", word, known);
    }
    if (*method == MipMethod::none) return {};
    if (*method == MipMethod::box) return {MipmapSource::box};
    return {MipmapSource::none, method};
}

NamedTexture read_texture(const Section& section, const std::filesystem::path& directory,
                          GeneratedSets& sets) {
    int sources = 0;
    for (const char* key : {"file", "files", "texels", "generator"})
        sources += section.has(key) ? 1 : 0;
    if (sources != 1)
        section.fail("name",
                     fmt::format("{} has {} sources of texels, expected one of file, files, "
                                 "texels, generator",
                                 section.label(), sources));
    TextureDescription description;
    description.target =
        section.choice<TextureTarget>("target", kTargets).value_or(TextureTarget::two_d);
    if (description.target != TextureTarget::three_d && section.has("depth"))
        section.fail("depth", fmt::format("'depth' in {} whose target is not 3d", section.label()));
    description.depth = section.integer("depth", 1, Texture::kMaxSize).value_or(1);
    description.sampler = read_sampler(section, description.target);
    description.format =
        section.choice<TexelFormat>("format", kTexelFormats).value_or(TexelFormat::rgba8);
    const Mipmaps mipmaps = mipmaps_of(section);
    // hilo8 and its signed relative are stored as bytes.
    const bool words = description.format == TexelFormat::rgba16 ||
                       description.format == TexelFormat::hilo16 ||
                       description.format == TexelFormat::signed_hilo16;
    NamedTexture named =
        section.has("generator") ? read_generated(section, description, mipmaps.source, sets)
        : words ? read_images<Image16>(section, description, mipmaps.source, directory)
                : read_images<Image8>(section, description, mipmaps.source, directory);
    named.mipmaps = mipmaps.of_materials;
    return named;
}

}  // namespace

SetKey read_set_key(const Section& section, int largest) {
    const int seed = section.integer("seed", 0, std::numeric_limits<int>::max()).value_or(1);
    const std::optional<int> given = section.integer("size", 1, largest);
    const int size = section.integer("width", 1, largest).value_or(given.value_or(512));
    const int height = section.integer("height", 1, largest).value_or(size);
    if (given.value_or(size) != size || height != size)
        section.fail(height != size ? "height" : "size",
                     fmt::format("'{}' in {} differs from 'width', expected a square for a "
                                 "generated map",
                                 height != size ? "height" : "size", section.label()));
    return {static_cast<std::uint32_t>(seed), size};
}

TextureTable read_textures(const Section& root, const std::filesystem::path& directory) {
    TextureTable textures;
    GeneratedSets sets;
    for (const toml::table* table : root.tables("textures")) {
        const Section section(
            *table, "[[textures]]",
            {"name",       "file",  "width",         "height",    "texels",   "generator",
             "seed",       "size",  "map",           "format",    "target",   "filter",
             "mag_filter", "wrap",  "mipmaps",       "mip_files", "lod_bias", "border_color",
             "files",      "depth", "max_anisotropy"});
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
