#pragma once

#include <array>
#include <burnish/program_text.hpp>
#include <glm/glm.hpp>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/scene_io_toml.hpp"

namespace burnish {

/// Numbers that a key accepts, both ends included unless `open_low`.
struct Range {
    double low = -std::numeric_limits<float>::max();
    double high = std::numeric_limits<float>::max();
    bool open_low = false;  ///< `low` itself is refused
};

inline constexpr Range kUnit{0.0, 1.0};
inline constexpr Range kNotNegative{0.0};
inline constexpr Range kPositive{.low = 0.0, .open_low = true};

/// "FILE:LINE" of a node, or the override that it came from.
std::string place_of(const toml::node& node);

/// Throws Error{bad_input}: "FILE:LINE: message".
[[noreturn]] void fail_at(const toml::node& node, const std::string& message);

/// Names of an enumeration in the order in which messages list them.
template <class Enum>
using Names = std::span<const std::pair<std::string_view, Enum>>;

/// One table of a scene file. Every getter returns nothing for a missing key and throws
/// Error{bad_input} with file, line, what was found and what was expected for a wrong value.
class Section {
  public:
    /// `label` is how messages call the table, e.g. "[output]". A key that is not in `keys` is an
    /// error that names the nearest one that is.
    Section(const toml::table& table, std::string label,
            std::initializer_list<std::string_view> keys)
        : Section(table, std::move(label), std::span(keys.begin(), keys.size())) {}
    Section(const toml::table& table, std::string label, std::span<const std::string_view> keys);

    [[nodiscard]] bool has(std::string_view key) const;
    [[nodiscard]] bool has_table(std::string_view key) const;
    [[nodiscard]] bool has_text(std::string_view key) const;
    [[nodiscard]] bool has_number(std::string_view key) const;
    [[nodiscard]] const std::string& label() const { return m_label; }
    /// "FILE:LINE" of a key, or of the table if the key is missing.
    [[nodiscard]] std::string place(std::string_view key) const;

    [[nodiscard]] std::optional<int> integer(std::string_view key, int low, int high) const;
    [[nodiscard]] std::optional<float> number(std::string_view key, const Range& range = {}) const;
    /// The same as it stands in the file.
    [[nodiscard]] std::optional<double> exact_number(std::string_view key) const;
    [[nodiscard]] std::optional<bool> boolean(std::string_view key) const;
    [[nodiscard]] std::optional<std::string> text(std::string_view key) const;
    /// Same, but a missing or empty one is an error.
    [[nodiscard]] std::string required_text(std::string_view key) const;
    /// An array of `least` .. `most` numbers.
    [[nodiscard]] std::optional<std::vector<float>> numbers(std::string_view key, std::size_t least,
                                                            std::size_t most,
                                                            const Range& range = {}) const;
    [[nodiscard]] std::optional<glm::vec3> vec3(std::string_view key,
                                                const Range& range = {}) const;
    [[nodiscard]] std::optional<glm::vec4> vec4(std::string_view key,
                                                const Range& range = {}) const;
    /// 16 numbers, column after column.
    [[nodiscard]] std::optional<glm::mat4> mat4(std::string_view key) const;
    [[nodiscard]] std::optional<std::vector<std::string>> texts(std::string_view key) const;
    [[nodiscard]] const toml::table* table(std::string_view key) const;
    /// A value of any type; a missing one is an error.
    [[nodiscard]] const toml::node& required_node(std::string_view key) const;
    /// An array of tables; empty for a missing key.
    [[nodiscard]] std::vector<const toml::table*> tables(std::string_view key) const;

    template <class Enum>
    [[nodiscard]] std::optional<Enum> choice(std::string_view key, Names<Enum> names) const {
        const std::optional<std::string> word = text(key);
        if (!word) return std::nullopt;
        std::vector<std::string_view> known;
        for (const auto& [name, value] : names) {
            if (name == *word) return value;
            known.push_back(name);
        }
        fail_unknown_word(key, *word, known);
    }

    /// Error at a key, or at the table if the key is missing.
    [[noreturn]] void fail(std::string_view key, const std::string& message) const;
    /// Error in the text that a key holds: at FILE:LINE:COLUMN, or, where that cannot be told, at
    /// the key with line and column in its text.
    [[noreturn]] void fail_in_text(std::string_view key, const TextError& error) const;
    [[noreturn]] void fail_unknown_word(std::string_view key, std::string_view word,
                                        std::span<const std::string_view> known) const;

    /// A key that means something only beside another one.
    void refuse_without(std::string_view key, std::string_view other) const;

  private:
    const toml::node* find(std::string_view key) const;
    [[noreturn]] void fail_type(std::string_view key, const toml::node& found,
                                std::string_view expected) const;
    double checked(std::string_view key, const toml::node& node, const Range& range) const;

    const toml::table* m_table;
    std::string m_label;
};

}  // namespace burnish
