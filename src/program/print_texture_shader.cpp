#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>

#include "program/print_number.hpp"
#include "program/texture_words.hpp"

namespace burnish {
namespace {

[[noreturn]] void fail(std::size_t unit, const std::string& message) {
    throw Error(ErrorCode::bad_program, fmt::format("texture unit {}: {}", unit, message));
}

bool group_begins(const TextureShader& shader, std::size_t unit, const TextureGroup& group) {
    if (unit + group.count > shader.units.size()) return false;
    for (std::size_t i = 0; i < group.count; ++i) {
        if (shader.units[unit + i].operation != group.operations[i]) return false;
    }
    return true;
}

/// The word of each unit; groups are found from their first unit on.
std::array<TextureWord, kTextureShaderUnits> words_of(const TextureShader& shader) {
    std::array<TextureWord, kTextureShaderUnits> words;
    for (std::size_t unit = 0; unit < words.size();) {
        const TextureOperation operation = shader.units[unit].operation;
        if (single_word(operation)) {
            words[unit++].operation = operation;
            continue;
        }
        const auto* const group =
            std::find_if(kTextureGroups.begin(), kTextureGroups.end(),
                         [&](const TextureGroup& g) { return group_begins(shader, unit, g); });
        if (group == kTextureGroups.end())
            fail(unit,
                 fmt::format("{} is not part of a group of units that the text has a word for",
                             texture_operation_name(operation)));
        for (std::size_t i = 0; i < group->count; ++i)
            words[unit++] = {group->operations[i], group, i};
    }
    return words;
}

void require_readable(const TextureShader& shader, std::size_t unit) {
    const auto require = [&](std::size_t from) {
        if (!has_output(shader.units[from].operation))
            fail(unit, fmt::format("reads unit {}, whose operation {} has no output", from,
                                   texture_operation_name(shader.units[from].operation)));
    };
    const TextureOperation operation = shader.units[unit].operation;
    if (reads_previous(operation)) require(static_cast<std::size_t>(shader.units[unit].previous));
    if (operation != TextureOperation::texture_brdf) return;
    if (unit < 2) fail(unit, "texture_brdf, expected two units in front of it");
    require(unit - 1);
    require(unit - 2);
}

/// What is left of `unit` when it goes through text.
TextureUnit expressed(const TextureUnit& unit) {
    TextureUnit kept;
    kept.operation = unit.operation;
    if (reads_previous(unit.operation)) kept.previous = unit.previous;
    switch (arguments_of(unit.operation)) {
        case TextureArguments::offset_scale:
            kept.offset_scale = unit.offset_scale;
            kept.offset_bias = unit.offset_bias;
            [[fallthrough]];
        case TextureArguments::offset:
            kept.offset_matrix = unit.offset_matrix;
            break;
        case TextureArguments::dot:
            kept.dot_mapping = unit.dot_mapping;
            break;
        case TextureArguments::cull:
            kept.cull = unit.cull;
            break;
        default:
            break;
    }
    if (unit.operation == TextureOperation::dot_product_const_eye_reflect_cube_map)
        kept.const_eye = unit.const_eye;
    return kept;
}

std::string offset_arguments(const TextureUnit& unit) {
    std::string text = fmt::format("tex{}", unit.previous);
    for (int i = 0; i < 4; ++i) text += ", " + print_number(unit.offset_matrix[i / 2][i % 2]);
    return text;
}

std::string dot_arguments(const TextureShader& shader, std::size_t unit, const TextureWord& word) {
    const TextureUnit& u = shader.units[unit];
    std::string text = fmt::format("tex{}", u.previous);
    if (u.dot_mapping == DotMapping::expand) text = "expand(" + text + ")";
    if (u.dot_mapping == DotMapping::force_blue_to_one) text = "force_blue_to_one(" + text + ")";
    if (!word.begins_group() || !word.group->const_eye) return text;
    const glm::vec3& eye = shader.units[unit + word.group->count - 1].const_eye;
    for (int i = 0; i < 3; ++i) text += ", " + print_number(eye[i]);
    return text;
}

std::string cull_arguments(const TextureUnit& unit) {
    std::string text;
    for (const CullTest test : unit.cull)
        text += fmt::format("{}{}", text.empty() ? "" : ", ",
                            test == CullTest::less_than_zero ? "LESS_THAN_ZERO" : "GEQUAL_TO_ZERO");
    return text;
}

std::string arguments(const TextureShader& shader, std::size_t unit, const TextureWord& word) {
    const TextureUnit& u = shader.units[unit];
    switch (arguments_of(u.operation)) {
        case TextureArguments::none:
            return "";
        case TextureArguments::previous:
            return fmt::format("tex{}", u.previous);
        case TextureArguments::offset:
            return offset_arguments(u);
        case TextureArguments::offset_scale:
            return fmt::format("{}, {}, {}", offset_arguments(u), print_number(u.offset_scale),
                               print_number(u.offset_bias));
        case TextureArguments::dot:
            return dot_arguments(shader, unit, word);
        case TextureArguments::cull:
            return cull_arguments(u);
    }
    return "";
}

std::string statement(const TextureShader& shader, std::size_t unit, const TextureWord& word) {
    const std::string name = word.group != nullptr ? group_word(*word.group, word.index)
                                                   : std::string(*single_word(word.operation));
    return fmt::format("{}({})", name, arguments(shader, unit, word));
}

}  // namespace

std::string print_texture_unit(const TextureShader& shader, int unit) {
    const auto index = static_cast<std::size_t>(unit);
    return statement(shader, index, words_of(shader)[index]);
}

std::string print_texture_shader(const TextureShader& shader) {
    if (shader.bump_source != BumpSource::dsdt)
        throw Error(ErrorCode::bad_program, "no text can say that offsets come from rgba8 texels");
    for (std::size_t unit = 0; unit < shader.units.size(); ++unit) {
        if (shader.units[unit].dot_mapping >= DotMapping::nv2a_d3d)
            fail(unit, "a dot mapping of the NV2A, which no text can say");
    }
    shader.validate(Machine());
    const auto words = words_of(shader);
    std::string text = "!!TS1.0\n";
    for (std::size_t unit = 0; unit < words.size(); ++unit) {
        require_readable(shader, unit);
        if (!(expressed(shader.units[unit]) == shader.units[unit]))
            fail(unit, fmt::format("has a field that {} has no use for",
                                   texture_operation_name(shader.units[unit].operation)));
        text += statement(shader, unit, words[unit]) + ";\n";
    }
    return text;
}

}  // namespace burnish
