#include "io/scene_io_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>

#include "core/nearest.hpp"
#include "io/scene_io_text.hpp"

namespace burnish {
namespace {

std::string_view type_name(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
            return "an integer";
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "a boolean";
        default:
            return "a date or time";
    }
}

std::string describe(const Range& range) {
    constexpr double kFar = std::numeric_limits<float>::max();
    if (range.low == -kFar && range.high == kFar) return "a number";
    if (range.high == kFar)
        return fmt::format("a number {} {}", range.open_low ? "above" : "of at least", range.low);
    return fmt::format("a number {} {} and at most {}", range.open_low ? "above" : "of at least",
                       range.low, range.high);
}

}  // namespace

std::string place_of(const toml::node& node) {
    const toml::source_region& source = node.source();
    const std::string path = source.path ? *source.path : std::string("scene");
    if (path.starts_with("-D ") || source.begin.line == 0) return path;
    return fmt::format("{}:{}", path, source.begin.line);
}

void fail_at(const toml::node& node, const std::string& message) {
    throw Error(ErrorCode::bad_input, place_of(node) + ": " + message);
}

Section::Section(const toml::table& table, std::string label,
                 std::span<const std::string_view> keys)
    : m_table(&table), m_label(std::move(label)) {
    for (const auto& [key, node] : table) {
        if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
        fail_at(node, fmt::format("unknown key '{}' in {}, {}", key.str(), m_label,
                                  expected_one_of(key.str(), keys)));
    }
}

const toml::node* Section::find(std::string_view key) const {
    return m_table->get(key);
}

bool Section::has(std::string_view key) const {
    return find(key) != nullptr;
}

std::string Section::place(std::string_view key) const {
    const toml::node* node = find(key);
    return place_of(node != nullptr ? *node : *m_table);
}

void Section::fail(std::string_view key, const std::string& message) const {
    throw Error(ErrorCode::bad_input, place(key) + ": " + message);
}

void Section::fail_in_text(std::string_view key, const TextError& error) const {
    const std::string text = required_text(key);
    std::size_t offset = 0;
    for (std::size_t line = 1; line < error.line; ++line) offset = text.find('\n', offset) + 1;
    offset += error.column - 1;
    const std::string place = place_in_string(*find(key), offset)
                                  .value_or(fmt::format("{}: {}:{}:{}", place_of(*find(key)), key,
                                                        error.line, error.column));
    throw Error(ErrorCode::bad_input, place + ": " + error.message);
}

void Section::fail_type(std::string_view key, const toml::node& found,
                        std::string_view expected) const {
    fail_at(found,
            fmt::format("'{}' in {} is {}, expected {}", key, m_label, type_name(found), expected));
}

void Section::fail_unknown_word(std::string_view key, std::string_view word,
                                std::span<const std::string_view> known) const {
    fail(key,
         fmt::format("'{}' = \"{}\" in {}, {}", key, word, m_label, expected_one_of(word, known)));
}

std::optional<int> Section::integer(std::string_view key, int low, int high) const {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const std::string expected = fmt::format("an integer of {} .. {}", low, high);
    if (!node->is_integer()) fail_type(key, *node, expected);
    const std::int64_t value = node->as_integer()->get();
    if (value < low || value > high)
        fail(key, fmt::format("'{}' = {} in {}, expected {}", key, value, m_label, expected));
    return static_cast<int>(value);
}

double Section::checked(std::string_view key, const toml::node& node, const Range& range) const {
    if (!node.is_number()) fail_type(key, node, describe(range));
    const double value = node.is_integer() ? static_cast<double>(node.as_integer()->get())
                                           : node.as_floating_point()->get();
    const bool above = range.open_low ? value > range.low : value >= range.low;
    if (!above || !(value <= range.high))
        fail_at(node, fmt::format("'{}' in {} has the value {}, expected {}", key, m_label, value,
                                  describe(range)));
    return value;
}

std::optional<float> Section::number(std::string_view key, const Range& range) const {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    return static_cast<float>(checked(key, *node, range));
}

std::optional<double> Section::exact_number(std::string_view key) const {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    return checked(key, *node, {});
}

std::optional<bool> Section::boolean(std::string_view key) const {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_boolean()) fail_type(key, *node, "true or false");
    return node->as_boolean()->get();
}

std::optional<std::string> Section::text(std::string_view key) const {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_string()) fail_type(key, *node, "a string");
    return node->as_string()->get();
}

std::string Section::required_text(std::string_view key) const {
    std::optional<std::string> word = text(key);
    if (!word || word->empty()) fail(key, fmt::format("{} has no '{}'", m_label, key));
    return *std::move(word);
}

std::optional<std::vector<float>> Section::numbers(std::string_view key, std::size_t least,
                                                   std::size_t most, const Range& range) const {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const std::string expected = least == most
                                     ? fmt::format("an array of {} numbers", least)
                                     : fmt::format("an array of {} to {} numbers", least, most);
    const toml::array* array = node->as_array();
    if (array == nullptr) fail_type(key, *node, expected);
    if (array->size() < least || array->size() > most)
        fail(key, fmt::format("'{}' in {} has {} elements, expected {}", key, m_label,
                              array->size(), expected));
    std::vector<float> values;
    values.reserve(array->size());
    for (const toml::node& element : *array)
        values.push_back(static_cast<float>(checked(key, element, range)));
    return values;
}

std::optional<glm::vec3> Section::vec3(std::string_view key, const Range& range) const {
    const auto v = numbers(key, 3, 3, range);
    if (!v) return std::nullopt;
    return glm::vec3((*v)[0], (*v)[1], (*v)[2]);
}

std::optional<glm::vec4> Section::vec4(std::string_view key, const Range& range) const {
    const auto v = numbers(key, 4, 4, range);
    if (!v) return std::nullopt;
    return glm::vec4((*v)[0], (*v)[1], (*v)[2], (*v)[3]);
}

std::optional<glm::mat4> Section::mat4(std::string_view key) const {
    const auto v = numbers(key, 16, 16);
    if (!v) return std::nullopt;
    glm::mat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = (*v)[static_cast<std::size_t>(i)];
    return matrix;
}

std::optional<std::vector<std::string>> Section::texts(std::string_view key) const {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const toml::array* array = node->as_array();
    if (array == nullptr) fail_type(key, *node, "an array of strings");
    std::vector<std::string> values;
    for (const toml::node& element : *array) {
        if (!element.is_string()) fail_type(key, element, "an array of strings");
        values.push_back(element.as_string()->get());
    }
    return values;
}

bool Section::has_table(std::string_view key) const {
    const toml::node* node = find(key);
    return node != nullptr && node->is_table();
}

bool Section::has_text(std::string_view key) const {
    const toml::node* node = find(key);
    return node != nullptr && node->is_string();
}

bool Section::has_number(std::string_view key) const {
    const toml::node* node = find(key);
    return node != nullptr && node->is_number();
}

const toml::table* Section::table(std::string_view key) const {
    const toml::node* node = find(key);
    if (node == nullptr) return nullptr;
    if (!node->is_table()) fail_type(key, *node, "a table");
    return node->as_table();
}

const toml::node& Section::required_node(std::string_view key) const {
    const toml::node* node = find(key);
    if (node == nullptr) fail(key, fmt::format("{} has no '{}'", m_label, key));
    return *node;
}

std::vector<const toml::table*> Section::tables(std::string_view key) const {
    std::vector<const toml::table*> result;
    const toml::node* node = find(key);
    if (node == nullptr) return result;
    const toml::array* array = node->as_array();
    if (array == nullptr) fail_type(key, *node, "an array of tables");
    for (const toml::node& element : *array) {
        if (!element.is_table()) fail_type(key, element, "an array of tables");
        result.push_back(element.as_table());
    }
    return result;
}

void Section::refuse_without(std::string_view key, std::string_view other) const {
    if (has(key) && !has(other))
        fail(key, fmt::format("'{}' in {} without '{}'", key, m_label, other));
}

}  // namespace burnish
