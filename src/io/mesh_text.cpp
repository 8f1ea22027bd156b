#include "io/mesh_text.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <limits>

namespace burnish {
namespace {

/// What a number that from_chars calls out of range rounds to: its exponent's sign decides.
float out_of_range(std::string_view text, bool negative) {
    const std::size_t exponent = text.find_first_of("eE");
    const bool tiny = exponent != std::string_view::npos && exponent + 1 < text.size() &&
                      text[exponent + 1] == '-';
    const bool fraction_only = exponent == std::string_view::npos && text.front() == '0';
    const float size = tiny || fraction_only ? 0.0F : std::numeric_limits<float>::infinity();
    return negative ? -size : size;
}

bool word_ends(std::string_view text) {
    return text.empty() || is_blank(text.front()) || text.front() == '\n';
}

}  // namespace

void mesh_error(const MeshText& file, std::size_t line, const std::string& message) {
    throw Error(ErrorCode::bad_input, line != 0 ? fmt::format("{}:{}: {}", file.name, line, message)
                                                : fmt::format("{}: {}", file.name, message));
}

std::string in_quotes(std::string_view word) {
    constexpr std::size_t kLongest = 32;
    std::string text = "'";
    for (const char c : word.substr(0, kLongest)) text += c >= ' ' && c <= '~' ? c : '?';
    if (word.size() > kLongest) text += "...";
    return text + "'";
}

bool take_float(std::string_view& rest, float& value) {
    std::string_view text = rest;
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    const char* end = text.data() + text.size();
    const auto [after, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc::invalid_argument) return false;
    const bool negative = text.front() == '-';
    const std::string_view number(text.data(), static_cast<std::size_t>(after - text.data()));
    if (error == std::errc::result_out_of_range)
        value = out_of_range(number.substr(negative ? 1 : 0), negative);
    std::string_view behind(after, static_cast<std::size_t>(end - after));
    if (!behind.empty() && behind.front() == '#') {
        value = std::numeric_limits<float>::quiet_NaN();
        while (!word_ends(behind)) behind.remove_prefix(1);
    }
    rest = behind;
    return true;
}

bool take_integer(std::string_view& rest, std::int64_t& value) {
    std::string_view text = rest;
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    const char* end = text.data() + text.size();
    const auto [after, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc()) return false;
    rest = {after, static_cast<std::size_t>(end - after)};
    return true;
}

void LineWords::skip_blanks() {
    while (!m_rest.empty() && is_blank(m_rest.front())) m_rest.remove_prefix(1);
}

std::string_view LineWords::word() {
    skip_blanks();
    std::size_t length = 0;
    while (length < m_rest.size() && !is_blank(m_rest[length])) ++length;
    const std::string_view result = m_rest.substr(0, length);
    m_rest.remove_prefix(length);
    return result;
}

void LineWords::fail_expected(std::string_view what) {
    const std::string_view found = word();
    fail(found.empty() ? fmt::format("found the end of the line, expected {}", what)
                       : fmt::format("found {}, expected {}", in_quotes(found), what));
}

bool LineWords::optional_number(float& value) {
    skip_blanks();
    if (m_rest.empty() || m_rest.front() == '#') return false;
    std::string_view rest = m_rest;
    if (!take_float(rest, value) || !word_ends(rest)) fail_expected("a number");
    m_rest = rest;
    return true;
}

float LineWords::number() {
    float value = 0.0F;
    if (!optional_number(value)) fail_expected("a number");
    return value;
}

std::int64_t LineWords::integer() {
    skip_blanks();
    std::int64_t value = 0;
    std::string_view rest = m_rest;
    if (!take_integer(rest, value) || !word_ends(rest)) fail_expected("a whole number");
    m_rest = rest;
    return value;
}

void LineWords::fail(const std::string& message) const {
    mesh_error(*m_file, m_number, message);
}

std::string_view LineReader::physical_line() {
    const char* begin = m_file->bytes.data() + m_offset;
    const std::size_t left = m_file->bytes.size() - m_offset;
    const auto* newline = static_cast<const char*>(std::memchr(begin, '\n', left));
    const std::size_t length =
        newline != nullptr ? static_cast<std::size_t>(newline - begin) : left;
    m_offset += length + (newline != nullptr ? 1 : 0);
    ++m_number;
    std::string_view line(begin, length);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
}

bool LineReader::next() {
    if (m_offset >= m_file->bytes.size()) return false;
    m_line = physical_line();
    m_first_number = m_number;
    if (m_continuation == Continuation::none || m_line.empty() || m_line.back() != '\\')
        return true;
    m_joined.assign(m_line.substr(0, m_line.size() - 1));
    while (m_offset < m_file->bytes.size()) {
        const std::string_view more = physical_line();
        const bool goes_on = !more.empty() && more.back() == '\\';
        m_joined += ' ';
        m_joined += more.substr(0, more.size() - (goes_on ? 1 : 0));
        if (!goes_on) break;
    }
    m_line = m_joined;
    return true;
}

}  // namespace burnish
