#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <span>
#include <utility>

#include "core/nearest.hpp"
#include "io/scene_io.hpp"
#include "io/scene_io_parts.hpp"

namespace burnish {
namespace {

constexpr std::array<std::string_view, 44> kKeys{"name",
                                                 "model",
                                                 "model_text",
                                                 "kd",
                                                 "ks",
                                                 "alpha_x",
                                                 "alpha_y",
                                                 "exponent",
                                                 "exponent_coding",
                                                 "N",
                                                 "nu",
                                                 "nv",
                                                 "normal_map",
                                                 "direction",
                                                 "direction_map",
                                                 "tangent_map",
                                                 "bitangent_map",
                                                 "map_scale",
                                                 "specular_map",
                                                 "encoding",
                                                 "normal_y",
                                                 "srgb_colors",
                                                 "mipmaps",
                                                 "mipmap_bits",
                                                 "max_anisotropy",
                                                 "generator",
                                                 "seed",
                                                 "size",
                                                 "alpha_test",
                                                 "alpha_ref",
                                                 "units",
                                                 "inputs",
                                                 "combiners",
                                                 "combiners_text",
                                                 "texture_shader",
                                                 "texture_shader_text",
                                                 "const0",
                                                 "const1",
                                                 "const0_bytes",
                                                 "const1_bytes",
                                                 "fog",
                                                 "clamp_color_sum",
                                                 "hardware",
                                                 "file"};
/// Those of a material file, which does not refer to another one.
constexpr std::span<const std::string_view> kFileKeys(kKeys.data(), kKeys.size() - 1);

/// Those of read_reflectance().
constexpr std::span<const std::string_view> kReflectanceKeys(kKeys.data() + 1, 23);

AlphaTest read_alpha_test(const Section& section, AlphaTest test) {
    test.reference = section.number("alpha_ref", kUnit).value_or(test.reference);
    std::array<std::pair<std::string_view, Comparison>, kComparisons.size() + 1> names{
        {{"off", Comparison::always}}};
    std::copy(kComparisons.begin(), kComparisons.end(), names.begin() + 1);
    test.pass = section.choice<Comparison>("alpha_test", names).value_or(test.pass);
    return test;
}

Material referenced_material(const Section& section, const std::filesystem::path& directory) {
    try {
        return read_material_file(directory / section.required_text("file"));
    } catch (const Error& error) {
        throw Error(error.code(), section.place("file") + ": " + error.what());
    }
}

/// What the other keys change: a default, another file's material, or a generated one.
Material read_base(const Section& section, const std::filesystem::path& directory) {
    if (section.has("file") && section.has("generator"))
        section.fail("file", fmt::format("{} has both 'file' and 'generator', expected one",
                                         section.label()));
    if (section.has("file")) return referenced_material(section, directory);
    for (const std::string_view key : {"seed", "size"}) section.refuse_without(key, "generator");
    const std::optional<std::string> generator = section.text("generator");
    if (!generator) return {};
    const std::vector<std::string_view> known = generated_set_names();
    if (std::find(known.begin(), known.end(), *generator) == known.end())
        section.fail_unknown_word("generator", *generator, known);
    const SetKey key = read_set_key(section, kMaxGeneratedSize);
    return generated_material(*generator, key.seed, key.size);
}

Material read_material(const Section& section, const TextureTable& textures,
                       const std::filesystem::path& directory) {
    for (const std::string_view pipeline : {"units", "combiners", "combiners_text"}) {
        for (const std::string_view key : {"model", "model_text", "generator", "file"}) {
            if (section.has(pipeline) && section.has(key))
                section.fail(pipeline, fmt::format("{} has both '{}' and '{}', expected one: a "
                                                   "pipeline or a model",
                                                   section.label(), pipeline, key));
        }
    }
    section.refuse_without("alpha_ref", "alpha_test");
    Material material = read_base(section, directory);
    material.alpha_test = read_alpha_test(section, material.alpha_test);
    if (std::optional<ProgramMaterial> program = read_program(section, textures, directory))
        material.program = std::move(program);
    if (!material.program) {
        read_reflectance(section, textures, material);
        return material;
    }
    for (const std::string_view key : {"mipmaps", "mipmap_bits", "max_anisotropy"}) {
        if (section.has(key))
            section.fail(key, fmt::format("'{}' in {}, which is a pipeline, expected a reflectance "
                                          "model",
                                          key, section.label()));
    }
    for (const std::string_view key : kReflectanceKeys) {
        if (section.has("file") && section.has(key))
            section.fail(key, fmt::format("'{}' in {} changes a model, and '{}' is a pipeline", key,
                                          section.label(), *section.text("file")));
    }
    return material;
}

bool names_pipeline(const Section& section, const Material& material) {
    return material.program || section.has("model") || section.has("model_text") ||
           section.has("generator") || section.has("file");
}

}  // namespace

MaterialTable read_materials(const Section& root, const TextureTable& textures,
                             const std::filesystem::path& directory) {
    MaterialTable materials;
    for (const toml::table* table : root.tables("materials")) {
        const Section section(*table, "[[materials]]", kKeys);
        const std::string name = section.required_text("name");
        require_new_name(section, materials, name);
        Material material = read_material(section, textures, directory);
        material.name = name;
        const bool named = names_pipeline(section, material);
        materials.emplace(
            name, NamedMaterial{std::make_shared<const Material>(std::move(material)), named});
    }
    return materials;
}

Material read_one_material(const Section& root, const TextureTable& textures,
                           const std::filesystem::path& path) {
    const toml::table* table = root.table("material");
    if (table == nullptr) root.fail("material", "no [material] table, expected one");
    const Section section(*table, "[material]", kFileKeys);
    Material material = read_material(section, textures, path.parent_path());
    material.name = section.text("name").value_or(path.stem().string());
    return material;
}

}  // namespace burnish
