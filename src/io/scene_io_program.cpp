#include <fmt/format.h>

#include <array>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>
#include <cmath>
#include <utility>

#include "core/nearest.hpp"
#include "core/read_text.hpp"
#include "io/scene_io_parts.hpp"
#include "machine/unit_operations.hpp"

namespace burnish {
namespace {

/// Inputs with their words.
template <class Input, class... More>
std::array<std::pair<std::string_view, Input>, 1 + sizeof...(More)> named(Input first,
                                                                          More... more) {
    return {{{input_name(first), first}, {input_name(more), more}...}};
}
const auto kRgbInputs =
    named(ColorInput::vertex, ColorInput::half_tangent, ColorInput::light_tangent,
          ColorInput::view_tangent, ColorInput::normal, ColorInput::n_dot_l, ColorInput::h_dot_l);
const auto kAlphaInputs = named(ColorInput::vertex, ColorInput::n_dot_l, ColorInput::h_dot_l);
const auto kCoordinateInputs =
    named(CoordinateInput::uv, CoordinateInput::half_tangent, CoordinateInput::light_tangent,
          CoordinateInput::view_tangent, CoordinateInput::half_coded, CoordinateInput::light_coded,
          CoordinateInput::view_coded, CoordinateInput::vertex);
constexpr std::array<std::pair<std::string_view, BumpSource>, 2> kBumpSources{
    {{"dsdt", BumpSource::dsdt}, {"rgba8", BumpSource::rgba8}}};
constexpr std::array<std::pair<std::string_view, MuxBit>, 2> kMuxBits{
    {{"msb", MuxBit::msb}, {"lsb", MuxBit::lsb}}};

void read_inputs(const Section& material, ProgramMaterial& program) {
    const toml::table* table = material.table("inputs");
    if (table == nullptr) return;
    const Section section(
        *table, "[materials.inputs]",
        {"col0_rgb", "col0_a", "col1_rgb", "col1_a", "half_scale", "uv0", "uv1", "uv2", "uv3"});
    constexpr std::array<std::string_view, 4> kSets{"uv0", "uv1", "uv2", "uv3"};
    for (std::size_t i = 0; i < kSets.size(); ++i) {
        program.uv[i] =
            section.choice<CoordinateInput>(kSets[i], kCoordinateInputs).value_or(program.uv[i]);
    }
    program.col0_rgb =
        section.choice<ColorInput>("col0_rgb", kRgbInputs).value_or(program.col0_rgb);
    program.col0_a = section.choice<ColorInput>("col0_a", kAlphaInputs).value_or(program.col0_a);
    program.col1_rgb =
        section.choice<ColorInput>("col1_rgb", kRgbInputs).value_or(program.col1_rgb);
    program.col1_a = section.choice<ColorInput>("col1_a", kAlphaInputs).value_or(program.col1_a);
    program.half_scale = section.vec3("half_scale", kPositive).value_or(program.half_scale);
}

std::vector<TexturePtr> read_units(const Section& section, const TextureTable& textures) {
    constexpr std::size_t kMostUnits = 16;
    const std::vector<std::string> names =
        section.texts("units").value_or(std::vector<std::string>{});
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
        if (!name.empty() && found->second.mipmaps)
            section.fail("units", fmt::format("'units' in {} names '{}', whose 'mipmaps' are those "
                                              "of a reflectance model, expected none, box or files",
                                              section.label(), name));
        units.push_back(name.empty() ? nullptr : found->second.texture);
    }
    return units;
}

/// The first error of a text, and how many more there are.
[[noreturn]] void fail_text(const std::string& place, const std::vector<TextError>& errors) {
    const TextError& first = errors.front();
    const std::string more =
        errors.size() > 1 ? fmt::format(" (and {} more)", errors.size() - 1) : std::string();
    throw Error(ErrorCode::bad_input,
                fmt::format("{}:{}: {}{}", place, first.column, first.message, more));
}

/// The program that `key` names as a file or that `key`_text holds; nothing if neither is there.
template <class Program>
std::optional<Program> read_text_program(const Section& section, const std::string& key,
                                         const std::filesystem::path& directory,
                                         Parsed<Program> (*parse)(std::string_view)) {
    const std::string text_key = key + "_text";
    const auto file = section.text(key), text = section.text(text_key);
    if (file && text)
        section.fail(text_key, fmt::format("{} has both '{}' and '{}', expected one",
                                           section.label(), key, text_key));
    if (!file && !text) return std::nullopt;
    const std::filesystem::path path = file ? directory / *file : std::filesystem::path();
    const auto read_file = [&] {
        try {
            return read_text(path);
        } catch (const Error& error) {
            throw Error(error.code(), section.place(key) + ": " + error.what());
        }
    };
    Parsed<Program> parsed = parse(file ? read_file() : *text);
    if (parsed.program) return std::move(parsed.program);
    const std::size_t line = parsed.errors.front().line;
    fail_text(file ? fmt::format("{}:{}", path.string(), line)
                   : fmt::format("{}: {}:{}", section.place(text_key), text_key, line),
              parsed.errors);
}

/// `key` as numbers in [0, 1], or `key`_bytes as codes.
std::optional<glm::vec4> read_constant(const Section& section, const std::string& key) {
    const std::string bytes_key = key + "_bytes";
    const auto value = section.vec4(key, kUnit);
    const auto bytes = section.vec4(bytes_key, {0.0, 255.0});
    if (value && bytes)
        section.fail(bytes_key, fmt::format("{} has both '{}' and '{}', expected one",
                                            section.label(), key, bytes_key));
    if (!bytes) return value;
    for (int c = 0; c < 4; ++c) {
        if ((*bytes)[c] != std::floor((*bytes)[c]))
            section.fail(bytes_key, fmt::format("'{}' in {} has the element {}, expected whole "
                                                "numbers 0 .. 255",
                                                bytes_key, section.label(), (*bytes)[c]));
    }
    return *bytes / 255.0F;
}

void read_complements(const Section& section, FinalCombiner& final) {
    for (const std::string& name :
         section.texts("complement").value_or(std::vector<std::string>{})) {
        if (name == "spare0") {
            final.complement_spare0 = true;
        } else if (name == "secondary") {
            final.complement_secondary = true;
        } else {
            constexpr std::array<std::string_view, 2> kKnown{"spare0", "secondary"};
            section.fail_unknown_word("complement", name, kKnown);
        }
    }
}

/// [[0, "ab"], [1, "cd"]]: stage and output.
void read_blue_to_alpha(const Section& section, const toml::table& table,
                        CombinerProgram& program) {
    if (!section.has("blue_to_alpha")) return;
    const auto fail = [&] {
        section.fail("blue_to_alpha",
                     fmt::format("'blue_to_alpha' in {}, expected pairs of a stage, 0 .. {}, and "
                                 "\"ab\" or \"cd\"",
                                 section.label(), program.stages.size() - 1));
    };
    const toml::array* pairs = table["blue_to_alpha"].as_array();
    if (pairs == nullptr) fail();
    for (const toml::node& node : *pairs) {
        const toml::array* pair = node.as_array();
        if (pair == nullptr || pair->size() != 2) fail();
        const auto stage = (*pair)[0].value_exact<std::int64_t>();
        const auto output = (*pair)[1].value_exact<std::string>();
        if (!stage || !output || *stage < 0 ||
            *stage >= static_cast<std::int64_t>(program.stages.size()) ||
            (*output != "ab" && *output != "cd"))
            fail();
        Portion& rgb = program.stages[static_cast<std::size_t>(*stage)].rgb;
        (*output == "ab" ? rgb.ab_blue_to_alpha : rgb.cd_blue_to_alpha) = true;
    }
}

/// Four digits for s, t, r, q of every unit that culls: 0 lets >= 0 pass, 1 lets < 0 pass.
void read_cull_bits(const Section& section, TextureShader& shader) {
    const std::optional<std::string> bits = section.text("cull_fragment_bits");
    if (!bits) return;
    if (bits->size() != 4 || bits->find_first_not_of("01") != std::string::npos)
        section.fail("cull_fragment_bits",
                     fmt::format("'cull_fragment_bits' = \"{}\" in {}, expected four digits 0 or 1",
                                 *bits, section.label()));
    bool culls = false;
    for (TextureUnit& unit : shader.units) {
        if (unit.operation != TextureOperation::cull_fragment) continue;
        culls = true;
        for (std::size_t c = 0; c < 4; ++c) {
            unit.cull.at(c) =
                (*bits)[c] == '1' ? CullTest::less_than_zero : CullTest::greater_or_equal_zero;
        }
    }
    if (!culls)
        section.fail("cull_fragment_bits",
                     fmt::format("'cull_fragment_bits' in {}, but no unit does cull_fragment",
                                 section.label()));
}

/// One code 0 .. 7 per unit, -1 where the text stands.
void read_dot_mappings(const Section& section, TextureShader& shader) {
    const std::optional<std::vector<float>> codes =
        section.numbers("dot_mapping", 1, kTextureShaderUnits, {-1.0, 7.0});
    if (!codes) return;
    constexpr std::array<DotMapping, 8> kCodes{DotMapping::unsigned_identity,
                                               DotMapping::nv2a_d3d,
                                               DotMapping::nv2a_gl,
                                               DotMapping::nv2a_signed,
                                               DotMapping::nv2a_hilo,
                                               DotMapping::nv2a_hemisphere_d3d,
                                               DotMapping::nv2a_hemisphere_gl,
                                               DotMapping::nv2a_hemisphere_signed};
    for (std::size_t i = 0; i < codes->size(); ++i) {
        const float code = (*codes)[i];
        if (code != std::floor(code))
            section.fail("dot_mapping", fmt::format("'dot_mapping' in {} has the element {}, "
                                                    "expected whole numbers -1 .. 7",
                                                    section.label(), code));
        if (code < 0.0F) continue;
        TextureUnit& unit = shader.units.at(i);
        if (!takes_dot_product(unit.operation))
            section.fail("dot_mapping",
                         fmt::format("'dot_mapping' in {} is for unit {}, which does {}, expected "
                                     "-1 or a dot product",
                                     section.label(), i, texture_operation_name(unit.operation)));
        unit.dot_mapping = kCodes.at(static_cast<std::size_t>(code));
    }
}

void read_hardware(const Section& material, ProgramMaterial& program) {
    const toml::table* table = material.table("hardware");
    if (table == nullptr) return;
    const Section section(*table, "[materials.hardware]",
                          {"mux_bit", "complement", "blue_to_alpha", "cull_fragment_bits",
                           "dot_mapping", "bump_source"});
    CombinerProgram& combiners = program.combiners;
    combiners.mux_bit = section.choice<MuxBit>("mux_bit", kMuxBits).value_or(combiners.mux_bit);
    read_complements(section, combiners.final_combiner);
    read_blue_to_alpha(section, *table, combiners);
    if (!program.texture_shader) {
        for (const std::string_view key : {"cull_fragment_bits", "dot_mapping", "bump_source"}) {
            if (section.has(key))
                section.fail(
                    key, fmt::format("'{}' in {} without a texture shader", key, section.label()));
        }
        return;
    }
    TextureShader& shader = *program.texture_shader;
    shader.bump_source =
        section.choice<BumpSource>("bump_source", kBumpSources).value_or(shader.bump_source);
    read_cull_bits(section, shader);
    read_dot_mappings(section, shader);
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

std::optional<ProgramMaterial> read_program(const Section& section, const TextureTable& textures,
                                            const std::filesystem::path& directory) {
    std::optional<CombinerProgram> combiners =
        read_text_program<CombinerProgram>(section, "combiners", directory, parse_combiners);
    if (!combiners && !section.has("units")) {
        for (const std::string_view key :
             {"inputs", "const0", "const1", "const0_bytes", "const1_bytes", "fog",
              "clamp_color_sum", "hardware", "texture_shader", "texture_shader_text"}) {
            if (section.has(key))
                section.fail(key, fmt::format("'{}' in {} without 'units' or 'combiners'", key,
                                              section.label()));
        }
        return std::nullopt;
    }
    ProgramMaterial program = vertex_color_program(read_units(section, textures));
    if (combiners) program.combiners = std::move(*combiners);
    program.texture_shader = read_text_program<TextureShader>(section, "texture_shader", directory,
                                                              parse_texture_shader);
    CombinerProgram& p = program.combiners;
    p.const0 = read_constant(section, "const0").value_or(p.const0);
    p.const1 = read_constant(section, "const1").value_or(p.const1);
    p.fog = section.vec4("fog", kUnit).value_or(p.fog);
    p.final_combiner.clamp_color_sum =
        section.boolean("clamp_color_sum").value_or(p.final_combiner.clamp_color_sum);
    read_hardware(section, program);
    read_inputs(section, program);
    return program;
}

}  // namespace burnish
