#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/materials.hpp>
#include <utility>

#include "core/nearest.hpp"
#include "io/scene_io_parts.hpp"

namespace burnish {
namespace {

void refuse_unsupported(const Section& section) {
    section.accept_only("normal_y", "up");
    section.refuse({"texture_shader", "texture_shader_text"});
}

AlphaTest read_alpha_test(const Section& section) {
    AlphaTest test;
    test.reference = section.number("alpha_ref", kUnit).value_or(test.reference);
    std::array<std::pair<std::string_view, Comparison>, kComparisons.size() + 1> names{
        {{"off", Comparison::always}}};
    std::copy(kComparisons.begin(), kComparisons.end(), names.begin() + 1);
    test.pass = section.choice<Comparison>("alpha_test", names).value_or(test.pass);
    return test;
}

Model read_model(const Section& section) {
    const std::string name = section.text("model").value();
    const std::optional<Model> model = model_named(name);
    if (!model) section.fail_unknown_word("model", name, model_names());
    return *model;
}

/// The two maps belong together: both hold vectors scaled by the same m.
void read_vector_maps(const Section& section, const TextureTable& textures, Material& material) {
    const auto tangent = texture_of(section, "tangent_map", textures);
    const auto bitangent = texture_of(section, "bitangent_map", textures);
    if (tangent.has_value() != bitangent.has_value())
        section.fail(tangent ? "tangent_map" : "bitangent_map",
                     fmt::format("{} has one of tangent_map and bitangent_map, expected both or "
                                 "neither",
                                 section.label()));
    if (!tangent) return section.refuse_without("map_scale", "tangent_map");
    material.tangent_map = tangent->texture;
    material.bitangent_map = bitangent->texture;
    const bool same_set = tangent->map_scale == bitangent->map_scale;
    const float known = same_set ? tangent->map_scale : 0.0F;
    material.map_scale = section.number("map_scale", {0.0, 1.0}).value_or(known);
    const float m = material.map_scale;
    if (m != 1.0F && m != 0.5F && m != 0.25F && m != 0.125F)
        section.fail("map_scale",
                     fmt::format("'map_scale' = {} in {}, expected 1, 0.5, 0.25 or 0.125: "
                                 "what the vectors in its maps were multiplied with",
                                 m, section.label()));
}

void read_reflectance(const Section& section, const TextureTable& textures, Material& material) {
    constexpr Range kWidth{.low = 0.0, .high = 1.0, .open_low = true};
    material.kd = section.vec3("kd", kUnit).value_or(material.kd);
    material.ks = section.vec3("ks", kUnit).value_or(material.ks);
    material.alpha_x = section.number("alpha_x", kWidth).value_or(material.alpha_x);
    material.alpha_y = section.number("alpha_y", kWidth).value_or(material.alpha_y);
    if (const auto map = texture_of(section, "normal_map", textures))
        material.normal_map = map->texture;
    if (const auto map = texture_of(section, "specular_map", textures))
        material.specular_map = map->texture;
    read_vector_maps(section, textures, material);
}

}  // namespace

MaterialTable read_materials(const Section& root, const TextureTable& textures,
                             const std::filesystem::path& directory) {
    MaterialTable materials;
    for (const toml::table* table : root.tables("materials")) {
        const Section section(*table, "[[materials]]",
                              {"name",
                               "model",
                               "kd",
                               "ks",
                               "alpha_x",
                               "alpha_y",
                               "normal_map",
                               "tangent_map",
                               "bitangent_map",
                               "map_scale",
                               "specular_map",
                               "normal_y",
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
                               "hardware"});
        Material material;
        material.name = section.required_text("name");
        require_new_name(section, materials, material.name);
        refuse_unsupported(section);
        for (const std::string_view key : {"units", "combiners", "combiners_text"}) {
            if (section.has(key) && section.has("model"))
                section.fail(key, fmt::format("[[materials]] has both '{}' and 'model', expected "
                                              "one: a pipeline or a model",
                                              key));
        }
        section.refuse_without("alpha_ref", "alpha_test");
        material.alpha_test = read_alpha_test(section);
        if (section.has("model")) material.model = read_model(section);
        material.program = read_program(section, textures, directory);
        if (!material.program) read_reflectance(section, textures, material);
        const bool names_pipeline = material.program || section.has("model");
        const std::string name = material.name;
        materials.emplace(name, NamedMaterial{std::make_shared<const Material>(std::move(material)),
                                              names_pipeline});
    }
    return materials;
}

}  // namespace burnish
