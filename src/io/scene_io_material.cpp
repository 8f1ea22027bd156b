#include <fmt/format.h>

#include <array>
#include <burnish/materials.hpp>
#include <utility>

#include "core/nearest.hpp"
#include "io/scene_io_parts.hpp"

namespace burnish {
namespace {

constexpr std::array<std::pair<std::string_view, ColorInput>, 5> kRgbInputs{
    {{"vertex", ColorInput::vertex},
     {"half_tangent", ColorInput::half_tangent},
     {"light_tangent", ColorInput::light_tangent},
     {"view_tangent", ColorInput::view_tangent},
     {"n_dot_l", ColorInput::n_dot_l}}};
constexpr std::array<std::pair<std::string_view, ColorInput>, 2> kAlphaInputs{
    {{"vertex", ColorInput::vertex}, {"n_dot_l", ColorInput::n_dot_l}}};

void refuse_unsupported(const Section& section) {
    section.accept_only("alpha_test", "off");
    section.accept_only("normal_y", "up");
    section.refuse({"combiners", "combiners_text", "texture_shader", "texture_shader_text",
                    "const0", "const1", "const0_bytes", "const1_bytes", "fog", "clamp_color_sum",
                    "hardware"});
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

void read_inputs(const Section& material, ProgramMaterial& program) {
    const toml::table* table = material.table("inputs");
    if (table == nullptr) return;
    const Section section(*table, "[materials.inputs]",
                          {"col0_rgb", "col0_a", "col1_rgb", "col1_a", "uv0", "uv1", "uv2", "uv3"});
    for (const std::string_view key : {"uv0", "uv1", "uv2", "uv3"}) section.accept_only(key, "uv");
    for (const std::string_view key : {"col0_rgb", "col1_rgb"}) {
        if (section.has(key) && section.text(key) == "normal") section.refuse({key});
    }
    program.col0_rgb =
        section.choice<ColorInput>("col0_rgb", kRgbInputs).value_or(program.col0_rgb);
    program.col0_a = section.choice<ColorInput>("col0_a", kAlphaInputs).value_or(program.col0_a);
    program.col1_rgb =
        section.choice<ColorInput>("col1_rgb", kRgbInputs).value_or(program.col1_rgb);
    program.col1_a = section.choice<ColorInput>("col1_a", kAlphaInputs).value_or(program.col1_a);
}

ProgramMaterial read_program(const Section& section, const TextureTable& textures) {
    constexpr std::size_t kMostUnits = 16;
    const std::vector<std::string> names = section.texts("units").value();
    if (names.size() > kMostUnits)
        section.fail("units", fmt::format("'units' in {} has {} elements, expected at most {}",
                                          section.label(), names.size(), kMostUnits));
    std::vector<TexturePtr> units;
    for (const std::string& name : names) {
        const auto found = textures.find(name);
        if (!name.empty() && found == textures.end())
            section.fail("units", fmt::format("'units' in {} names the unknown texture '{}', {}",
                                              section.label(), name,
                                              expected_one_of(name, names_of(textures))));
        units.push_back(name.empty() ? nullptr : found->second.texture);
    }
    ProgramMaterial program = vertex_color_program(std::move(units));
    read_inputs(section, program);
    return program;
}

}  // namespace

ProgramMaterial vertex_color_program(std::vector<TexturePtr> units) {
    using namespace combine;
    const bool textured = !units.empty() && units[0] != nullptr;
    ProgramBuilder builder;
    const Input zero = raw(Register::zero);
    builder.lerp(raw(Register::col0), textured ? raw(tex(0)) : one(), zero, zero);
    builder.out_alpha(alpha(raw(Register::col0)));
    ProgramMaterial program;
    program.combiners = builder.build();
    program.units = std::move(units);
    return program;
}

MaterialTable read_materials(const Section& root, const TextureTable& textures) {
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
        const bool has_units = section.has("units");
        if (has_units && section.has("model"))
            section.fail("units",
                         "[[materials]] has both 'units' and 'model', expected one: a "
                         "pipeline or a model");
        if (section.has("model")) material.model = read_model(section);
        if (!has_units) section.refuse_without("inputs", "units");
        if (has_units) {
            material.program = read_program(section, textures);
        } else {
            read_reflectance(section, textures, material);
        }
        const bool names_pipeline = has_units || section.has("model");
        const std::string name = material.name;
        materials.emplace(name, NamedMaterial{std::make_shared<const Material>(std::move(material)),
                                              names_pipeline});
    }
    return materials;
}

}  // namespace burnish
