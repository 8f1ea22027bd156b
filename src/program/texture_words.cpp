#include "program/texture_words.hpp"

#include <fmt/format.h>

namespace burnish {

TextureArguments arguments_of(TextureOperation operation) {
    switch (operation) {
        case TextureOperation::cull_fragment:
            return TextureArguments::cull;
        case TextureOperation::offset_2d_scale:
        case TextureOperation::offset_rectangle_scale:
        case TextureOperation::offset_projective_2d_scale:
        case TextureOperation::offset_projective_rectangle_scale:
            return TextureArguments::offset_scale;
        default:
            break;
    }
    if (!reads_previous(operation)) return TextureArguments::none;
    if (operation >= TextureOperation::dot_product) return TextureArguments::dot;
    if (operation >= TextureOperation::dependent_ar) return TextureArguments::previous;
    return TextureArguments::offset;
}

std::string group_word(const TextureGroup& group, std::size_t index) {
    return fmt::format("{}_{}of{}", group.name, index + 1, group.count);
}

std::optional<std::string_view> single_word(TextureOperation operation) {
    if (operation == TextureOperation::none) return "nop";
    if (operation == TextureOperation::dot_product) return std::nullopt;
    for (const TextureGroup& group : kTextureGroups) {
        for (std::size_t i = 0; i < group.count; ++i) {
            if (group.operations[i] == operation) return std::nullopt;
        }
    }
    return texture_operation_name(operation);
}

std::optional<TextureWord> texture_word(std::string_view text) {
    for (int i = 0; i < kTextureOperationCount; ++i) {
        const auto operation = static_cast<TextureOperation>(i);
        if (single_word(operation) == text) return TextureWord{operation, nullptr, 0};
    }
    for (const TextureGroup& group : kTextureGroups) {
        if (!text.starts_with(group.name)) continue;
        for (std::size_t i = 0; i < group.count; ++i) {
            if (group_word(group, i) == text) return TextureWord{group.operations[i], &group, i};
        }
    }
    return std::nullopt;
}

std::vector<std::string> texture_words() {
    std::vector<std::string> words;
    for (int i = 0; i < kTextureOperationCount; ++i) {
        const auto word = single_word(static_cast<TextureOperation>(i));
        if (word) words.emplace_back(*word);
    }
    for (const TextureGroup& group : kTextureGroups) {
        for (std::size_t i = 0; i < group.count; ++i) words.push_back(group_word(group, i));
    }
    return words;
}

bool has_output(TextureOperation operation) {
    switch (operation) {
        case TextureOperation::none:
        case TextureOperation::cull_fragment:
        case TextureOperation::dot_product:
            return false;
        default:
            return !replaces_depth(operation);
    }
}

}  // namespace burnish
