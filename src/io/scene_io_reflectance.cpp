#include <fmt/format.h>

#include <array>
#include <burnish/materials.hpp>
#include <cmath>
#include <memory>
#include <utility>

#include "core/dmath.hpp"
#include "io/scene_io_parts.hpp"
#include "models/parse_model.hpp"
#include "models/vector_encoding.hpp"

namespace burnish {
namespace {

constexpr Range kWidth{.low = 0.0, .high = 1.0, .open_low = true};
constexpr Range kExponent{.low = 0.0, .high = 1e6, .open_low = true};
constexpr std::array<std::pair<std::string_view, VectorEncoding>, 4> kEncodings{
    {{"a", VectorEncoding::a},
     {"b", VectorEncoding::b},
     {"c", VectorEncoding::c},
     {"d", VectorEncoding::d}}};
constexpr std::array<std::pair<std::string_view, bool>, 2> kNormalY{
    {{"up", true}, {"down", false}}};
constexpr std::array<std::pair<std::string_view, int>, 4> kChannels{
    {{"r", 0}, {"g", 1}, {"b", 2}, {"a", 3}}};

void read_model(const Section& section, Material& material) {
    const std::optional<std::string> name = section.text("model");
    if (section.has("model_text")) {
        if (name && *name != "text")
            section.fail("model", fmt::format("{} has both 'model_text' and 'model' = \"{}\", "
                                              "expected one",
                                              section.label(), *name));
        material.model = Model::text;
        material.model_text = section.required_text("model_text");
        ExprBuilder builder;
        const Parsed<ExprPtr> parsed = parse_model(material.model_text, builder);
        if (!parsed.program) section.fail_in_text("model_text", parsed.errors.front());
        return;
    }
    if (!name) return;
    const std::optional<Model> model = model_named(*name);
    if (!model) section.fail_unknown_word("model", *name, model_names());
    material.model = *model;
    material.model_text.clear();
}

/// A parameter that may be a number, the name of a texture, or a table that says how to read it.
struct ParameterKey {
    std::string_view key;
    Range range;  ///< of the number, and of what a map may give
    int usual;    ///< its channel in a generated alpha map
    bool unit;    ///< whether 0 .. 1 makes sense for a map that says nothing else
    float* constant;
    ParameterMap* map;
};

/// `section` holds channel, low and high, if any; `key` the name of the texture.
ParameterMap parameter_map(const Section& section, const ParameterKey& parameter,
                           std::string_view key, const NamedTexture& texture) {
    ParameterMap map{texture.texture};
    const bool known = texture.ranges.has_value();
    map.channel = section.choice<int>("channel", kChannels).value_or(known ? parameter.usual : 0);
    if (known && map.channel < 3) {
        const CodedRange range = (*texture.ranges)[static_cast<std::size_t>(map.channel)];
        map.low = range.low;
        map.high = range.high;
    } else if (!parameter.unit && !section.has("high")) {
        section.fail(key, fmt::format("'{}' in {} is a map without a range, expected {{ map = "
                                      "\"...\", low = ..., high = ... }}",
                                      key, section.label()));
    }
    const Range ends{0.0, parameter.range.high};
    map.low = section.number("low", ends).value_or(map.low);
    map.high = section.number("high", ends).value_or(map.high);
    return map;
}

void read_parameter(const Section& section, const TextureTable& textures,
                    const ParameterKey& parameter) {
    const std::string_view key = parameter.key;
    if (section.has_text(key)) {
        *parameter.map =
            parameter_map(section, parameter, key, *texture_of(section, key, textures));
    } else if (section.has_table(key)) {
        const Section table(*section.table(key), fmt::format("'{}' of {}", key, section.label()),
                            {"map", "channel", "low", "high"});
        if (!table.has("map")) table.fail("map", fmt::format("{} has no 'map'", table.label()));
        *parameter.map =
            parameter_map(table, parameter, "map", *texture_of(table, "map", textures));
    } else if (const auto number = section.number(key, parameter.range)) {
        *parameter.constant = *number;
        *parameter.map = {};
    }
}

/// A colour that may be three numbers, one for grey, the name of a texture, or both in a table.
void read_color(const Section& section, std::string_view key, const TextureTable& textures,
                glm::vec3& color, TexturePtr& map) {
    if (section.has_text(key)) {
        map = texture_of(section, key, textures)->texture;
        color = glm::vec3(1.0F);
    } else if (section.has_table(key)) {
        const Section table(*section.table(key), fmt::format("'{}' of {}", key, section.label()),
                            {"map", "color"});
        if (!table.has("map")) table.fail("map", fmt::format("{} has no 'map'", table.label()));
        map = texture_of(table, "map", textures)->texture;
        color = table.vec3("color", kUnit).value_or(glm::vec3(1.0F));
    } else if (section.has_number(key)) {
        color = glm::vec3(section.number(key, kUnit).value());
        map = nullptr;
    } else if (const auto given = section.vec3(key, kUnit)) {
        color = *given;
        map = nullptr;
    }
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

/// One texel that says the same angle everywhere, in 16 bits.
TexturePtr constant_direction(double degrees, VectorEncoding encoding) {
    const double angle = degrees * dmath::kPi / 180.0;
    Image16 image(1, 1);
    const double vector[] = {dmath::cos(angle), dmath::sin(angle), 0.0};
    for (std::size_t k = 0; k < 3; ++k)
        image.rgba[k] = static_cast<std::uint16_t>(encode_vector_code(encoding, vector[k], 16));
    image.rgba[3] = 65535;
    TextureDescription description;
    description.format = TexelFormat::rgba16;
    return std::make_shared<const Texture>(std::span(&image, 1), description);
}

void read_direction(const Section& section, const TextureTable& textures, Material& material) {
    if (section.has("direction") && section.has("direction_map"))
        section.fail("direction", fmt::format("{} has both 'direction' and 'direction_map', "
                                              "expected one: an angle or a map",
                                              section.label()));
    if (const auto map = texture_of(section, "direction_map", textures))
        material.direction_map = map->texture;
    if (const auto degrees = section.number("direction", {-360.0, 360.0}))
        material.direction_map =
            constant_direction(static_cast<double>(*degrees), material.encoding);
}

/// The exponents of Ashikhmin and Shirley's model are another way to say its widths.
void read_phong_exponents(const Section& section, Material& material) {
    constexpr Range kPhongExponent{2.0, 2e6};
    const std::pair<std::string_view, std::string_view> keys[] = {{"nu", "alpha_x"},
                                                                  {"nv", "alpha_y"}};
    for (const auto& [key, width] : keys) {
        const auto n = section.number(key, kPhongExponent);
        if (!n) continue;
        if (material.model != Model::ashikhmin_shirley)
            section.fail(key, fmt::format("'{}' in {} without 'model' = \"ashikhmin_shirley\"", key,
                                          section.label()));
        if (section.has(width))
            section.fail(key, fmt::format("{} has both '{}' and '{}', expected one: {} = "
                                          "sqrt(2 / {})",
                                          section.label(), key, width, width, key));
        const auto alpha = static_cast<float>(std::sqrt(2.0 / static_cast<double>(*n)));
        (key == "nu" ? material.alpha_x : material.alpha_y) = alpha;
        (key == "nu" ? material.alpha_x_map : material.alpha_y_map) = {};
    }
}

}  // namespace

void read_reflectance(const Section& section, const TextureTable& textures, Material& material) {
    read_model(section, material);
    material.encoding =
        section.choice<VectorEncoding>("encoding", kEncodings).value_or(material.encoding);
    material.normal_y_up =
        section.choice<bool>("normal_y", kNormalY).value_or(material.normal_y_up);
    material.srgb_colors = section.boolean("srgb_colors").value_or(material.srgb_colors);
    if (section.has("exponent") && section.has("N"))
        section.fail("N", fmt::format("{} has both 'exponent' and 'N', two names of one number",
                                      section.label()));
    const ParameterKey parameters[] = {
        {"alpha_x", kWidth, 0, true, &material.alpha_x, &material.alpha_x_map},
        {"alpha_y", kWidth, 1, true, &material.alpha_y, &material.alpha_y_map},
        {section.has("N") ? "N" : "exponent", kExponent, 2, false, &material.exponent,
         &material.exponent_map}};
    for (const ParameterKey& parameter : parameters) read_parameter(section, textures, parameter);
    read_phong_exponents(section, material);
    read_color(section, "kd", textures, material.kd, material.kd_map);
    TexturePtr specular = material.specular_map;
    read_color(section, "ks", textures, material.ks, specular);
    if (const auto map = texture_of(section, "specular_map", textures)) {
        if (section.has_text("ks") || section.has_table("ks"))
            section.fail("specular_map", fmt::format("{} has both 'specular_map' and a map in "
                                                     "'ks', expected one",
                                                     section.label()));
        specular = map->texture;
    }
    material.specular_map = specular;
    if (const auto map = texture_of(section, "normal_map", textures))
        material.normal_map = map->texture;
    read_direction(section, textures, material);
    read_vector_maps(section, textures, material);
    read_mipmaps(section, textures, material);
}

}  // namespace burnish
