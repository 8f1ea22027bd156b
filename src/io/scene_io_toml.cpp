#include "io/scene_io_toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

#include "core/near_file.hpp"

namespace burnish {
namespace {

constexpr std::uintmax_t kLargestScene = 32U << 20;

std::string read_text(const std::filesystem::path& path) {
    std::error_code failure;
    if (std::filesystem::is_directory(path, failure))
        throw Error(ErrorCode::io, path.string() + ": is a directory, expected a scene file");
    const std::uintmax_t size = std::filesystem::file_size(path, failure);
    if (failure)
        throw Error(ErrorCode::io, path.string() + ": " + failure.message() + near_file(path));
    if (size > kLargestScene)
        throw Error(ErrorCode::limit, fmt::format("{}: {} bytes, expected a scene of at most {}",
                                                  path.string(), size, kLargestScene));
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file) throw Error(ErrorCode::io, path.string() + ": cannot be read");
    return text;
}

/// toml++ quotes the offending text, line breaks and all.
std::string one_line(std::string text) {
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    }
    return text;
}

/// An override cut at its dots: where it leads, and the table that holds its value under "value".
struct Override {
    std::string source;  ///< "-D camera.near=1", for messages
    std::vector<std::string> path;
    toml::table value;
};

[[noreturn]] void fail(const Override& change, const std::string& message) {
    throw Error(ErrorCode::bad_option, change.source + ": " + message);
}

toml::table parse_value(const std::string& text, const std::string& source) {
    try {
        return toml::parse("value = " + text, std::string_view(source));
    } catch (const toml::parse_error&) {
        // A bare word is a string: shells eat quotes.
        std::string quoted = "value = \"";
        for (const char c : text) {
            if (c == '"' || c == '\\') quoted += '\\';
            quoted += c;
        }
        return toml::parse(one_line(quoted) + "\"", std::string_view(source));
    }
}

Override parse_override(const std::string& text) {
    Override change;
    change.source = "-D " + text;
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) fail(change, "expected key.path=value");
    std::string_view rest = std::string_view(text).substr(0, equals);
    while (true) {
        const std::size_t dot = rest.find('.');
        change.path.emplace_back(rest.substr(0, dot));
        if (change.path.back().empty()) fail(change, "empty key, expected key.path=value");
        if (dot == std::string_view::npos) break;
        rest.remove_prefix(dot + 1);
    }
    try {
        change.value = parse_value(text.substr(equals + 1), change.source);
    } catch (const toml::parse_error&) {
        fail(change, "the value is not text, expected key.path=value");
    }
    return change;
}

std::optional<std::size_t> array_index(const toml::array& array, const std::string& step) {
    for (std::size_t i = 0; i < array.size(); ++i) {
        const toml::table* element = array[i].as_table();
        if (element != nullptr && element->get("name") != nullptr &&
            element->get("name")->value<std::string>() == step)
            return i;
    }
    std::size_t index = 0;
    const auto [end, failure] = std::from_chars(step.data(), step.data() + step.size(), index);
    if (failure != std::errc() || end != step.data() + step.size() || index >= array.size())
        return std::nullopt;
    return index;
}

/// The node that `step` names below `node`; tables that are not there yet are made.
toml::node& descend(toml::node& node, const std::string& step, const Override& change) {
    if (toml::table* table = node.as_table()) {
        if (table->get(step) == nullptr) {
            // Parsed rather than made, so that it knows where it came from.
            toml::table made = toml::parse("value = {}", std::string_view(change.source));
            table->insert_or_assign(step, std::move(*made["value"].as_table()));
        }
        return *table->get(step);
    }
    if (toml::array* array = node.as_array()) {
        if (const auto index = array_index(*array, step)) return (*array)[*index];
        fail(change, fmt::format("no element '{}' among {}", step, array->size()));
    }
    fail(change, fmt::format("'{}' stands below a value, expected a table", step));
}

void apply(toml::table& root, Override change) {
    toml::node* node = &root;
    for (std::size_t i = 0; i + 1 < change.path.size(); ++i)
        node = &descend(*node, change.path[i], change);
    const std::string& last = change.path.back();
    std::move(*change.value.get("value")).visit([&](auto&& value) {
        if (toml::table* table = node->as_table()) {
            table->insert_or_assign(last, std::move(value));
        } else if (toml::array* array = node->as_array()) {
            const auto index = array_index(*array, last);
            if (!index) fail(change, fmt::format("no element '{}' among {}", last, array->size()));
            array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(*index), std::move(value));
        } else {
            fail(change, fmt::format("'{}' stands below a value, expected a table", last));
        }
    });
}

}  // namespace

toml::table parse_scene_text(std::string_view text, const std::filesystem::path& path) {
    try {
        return toml::parse(text, std::string_view(path.native()));
    } catch (const toml::parse_error& error) {
        throw Error(ErrorCode::bad_input,
                    fmt::format("{}:{}: {}", path.string(), error.source().begin.line,
                                one_line(std::string(error.description()))));
    }
}

toml::table parse_scene(const std::filesystem::path& path,
                        const std::vector<std::string>& overrides) {
    toml::table root = parse_scene_text(read_text(path), path);
    for (const std::string& each : overrides) apply(root, parse_override(each));
    return root;
}

}  // namespace burnish
