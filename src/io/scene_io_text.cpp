#include "io/scene_io_text.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string_view>

namespace burnish {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

/// Goes through a string of TOML 1.0 as it stands in its file, byte of its value after byte.
class Walk {
  public:
    /// @param column  of the opening quote, in code points
    Walk(std::string_view file, std::size_t line, std::size_t column) : m_file(file) {
        while (m_line < line && !at_end()) step();
        for (std::size_t i = 1; i < column && !at_end(); ++i) {
            step();
            while (!at_end() && (static_cast<unsigned char>(here()) & 0xc0U) == 0x80U) step();
        }
        open();
    }

    /// Whether the next bytes of the value are `value`. Stands before the one after them then.
    bool take(std::string_view value) {
        if (m_quote != '"' && m_quote != '\'') return false;
        for (const char wanted : value) {
            skip_folded_lines();
            const std::string bytes = next();
            if (bytes.empty() || bytes[0] != wanted) return false;
            m_rest = bytes.substr(1);
        }
        if (m_rest.empty()) skip_folded_lines();
        return true;
    }

    [[nodiscard]] std::size_t line() const { return m_line; }
    [[nodiscard]] std::size_t column() const { return m_at - m_line_start + 1; }

  private:
    [[nodiscard]] bool at_end() const { return m_at >= m_file.size(); }
    [[nodiscard]] char here() const { return at_end() ? '\0' : m_file[m_at]; }
    void step() {
        if (m_file[m_at++] != '\n') return;
        ++m_line;
        m_line_start = m_at;
    }
    bool skip_line_end() {
        const std::size_t feed = here() == '\r' ? m_at + 1 : m_at;
        if (feed >= m_file.size() || m_file[feed] != '\n') return false;
        while (m_at <= feed) step();
        return true;
    }

    void open() {
        m_quote = here();
        if (m_quote != '"' && m_quote != '\'') return;
        m_is_long = m_file.substr(m_at, 3) == std::string(3, m_quote);
        for (int i = m_is_long ? 3 : 1; i > 0; --i) step();
        if (m_is_long) skip_line_end();
    }

    /// A backslash at the end of a line joins it to the next character that is not blank.
    void skip_folded_lines() {
        while (m_is_long && m_quote == '"' && m_rest.empty() && here() == '\\') {
            std::size_t after = m_at + 1;
            while (after < m_file.size() && is_blank(m_file[after])) ++after;
            if (after >= m_file.size() || (m_file[after] != '\r' && m_file[after] != '\n')) return;
            while (m_at < after) step();
            while (skip_line_end() || is_blank(here())) {
                if (is_blank(here())) step();
            }
        }
    }

    /// What the next character of the file, or escape, adds to the value.
    std::string next() {
        if (!m_rest.empty()) return m_rest;
        if (at_end()) return {};
        if (skip_line_end()) return "\n";
        const char c = here();
        step();
        if (c != '\\' || m_quote != '"') return std::string(1, c);
        const char escaped = here();
        if (at_end()) return {};
        step();
        constexpr std::string_view kLetters = "bfnrt", kCodes = "\b\f\n\r\t";
        const std::size_t known = kLetters.find(escaped);
        if (known != std::string_view::npos) return std::string(1, kCodes[known]);
        if (escaped != 'u' && escaped != 'U') return std::string(1, escaped);
        return code_point(escaped == 'u' ? 4 : 8);
    }

    std::string code_point(int digits) {
        std::uint32_t value = 0;
        for (; digits > 0 && !at_end(); --digits) {
            const char c = here();
            const int digit = c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10;
            value = 16 * value + static_cast<std::uint32_t>(digit);
            step();
        }
        const auto byte = [](std::uint32_t bits) { return static_cast<char>(bits); };
        const auto more = [&](int shift) { return byte(0x80U | ((value >> shift) & 0x3fU)); };
        if (value < 0x80U) return {byte(value)};
        if (value < 0x800U) return {byte(0xc0U | value >> 6), more(0)};
        if (value < 0x10000U) return {byte(0xe0U | value >> 12), more(6), more(0)};
        return {byte(0xf0U | value >> 18), more(12), more(6), more(0)};
    }

    std::string_view m_file;
    std::size_t m_at = 0, m_line = 1, m_line_start = 0;
    char m_quote = '\0';
    bool m_is_long = false;
    std::string m_rest;  ///< of an escape that is several bytes
};

}  // namespace

std::optional<std::string> place_in_string(const toml::node& string, std::size_t offset) {
    const toml::source_region& source = string.source();
    const auto* text = string.as_string();
    if (text == nullptr || !source.path || source.begin.line == 0 ||
        source.path->starts_with("-D "))
        return std::nullopt;
    std::ifstream stream(*source.path, std::ios::binary);
    const std::string file{std::istreambuf_iterator<char>(stream),
                           std::istreambuf_iterator<char>()};
    Walk walk(file, source.begin.line, source.begin.column);
    if (!stream || !walk.take(std::string_view(text->get()).substr(0, offset))) return std::nullopt;
    return fmt::format("{}:{}:{}", *source.path, walk.line(), walk.column());
}

}  // namespace burnish
