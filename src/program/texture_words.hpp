#pragma once

#include <array>
#include <burnish/texture_shader.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The statements of !!TS1.0. The word for an operation that one unit does alone is the operation's
/// name; operations that several units do together have a word per unit, `..._2of3`.
namespace burnish {

/// What stands between the parentheses.
enum class TextureArguments {
    none,
    previous,      ///< tex
    offset,        ///< tex, m0, m1, m2, m3
    offset_scale,  ///< tex, m0, m1, m2, m3, scale, bias
    dot,           ///< tex, expand(tex) or force_blue_to_one(tex)
    cull,          ///< four conditions
};
TextureArguments arguments_of(TextureOperation operation);

/// Units in a row that compute one result out of a dot product each.
struct TextureGroup {
    std::string_view name;
    std::size_t count;  ///< 2 or 3 units
    std::array<TextureOperation, 3> operations;
    bool const_eye;  ///< the first statement ends with the eye vector, which the last unit uses
};
inline constexpr std::array<TextureGroup, 9> kTextureGroups{{
    {"dot_product_2d", 2, {TextureOperation::dot_product, TextureOperation::dot_product_2d}, false},
    {"dot_product_rectangle",
     2,
     {TextureOperation::dot_product, TextureOperation::dot_product_rectangle},
     false},
    {"dot_product_depth_replace",
     2,
     {TextureOperation::dot_product, TextureOperation::dot_product_depth_replace},
     false},
    {"dot_product_3d",
     3,
     {TextureOperation::dot_product, TextureOperation::dot_product,
      TextureOperation::dot_product_3d},
     false},
    {"dot_product_cube_map",
     3,
     {TextureOperation::dot_product, TextureOperation::dot_product,
      TextureOperation::dot_product_cube_map},
     false},
    {"dot_product_reflect_cube_map_eye_from_qs",
     3,
     {TextureOperation::dot_product, TextureOperation::dot_product,
      TextureOperation::dot_product_reflect_cube_map},
     false},
    {"dot_product_reflect_cube_map_const_eye",
     3,
     {TextureOperation::dot_product, TextureOperation::dot_product,
      TextureOperation::dot_product_const_eye_reflect_cube_map},
     true},
    {"dot_product_cube_map_and_reflect_cube_map_eye_from_qs",
     3,
     {TextureOperation::dot_product, TextureOperation::dot_product_diffuse_cube_map,
      TextureOperation::dot_product_reflect_cube_map},
     false},
    {"dot_product_cube_map_and_reflect_cube_map_const_eye",
     3,
     {TextureOperation::dot_product, TextureOperation::dot_product_diffuse_cube_map,
      TextureOperation::dot_product_const_eye_reflect_cube_map},
     true},
}};

/// A statement's word: one operation, or number `index` (from 0) of a group.
struct TextureWord {
    TextureOperation operation = TextureOperation::none;
    const TextureGroup* group = nullptr;
    std::size_t index = 0;

    [[nodiscard]] bool begins_group() const { return group != nullptr && index == 0; }
};

/// "dot_product_2d_1of2"
std::string group_word(const TextureGroup& group, std::size_t index);

/// The word of an operation that one unit does alone; none for the others.
std::optional<std::string_view> single_word(TextureOperation operation);

std::optional<TextureWord> texture_word(std::string_view text);

/// Every word that texture_word knows.
std::vector<std::string> texture_words();

/// Whether later units may read what the operation leaves.
bool has_output(TextureOperation operation);

}  // namespace burnish
