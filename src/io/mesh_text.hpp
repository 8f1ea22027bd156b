#pragma once

#include <burnish/error.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/mesh_soup.hpp"

namespace burnish {

/// Throws Error{bad_input} "NAME:LINE: MESSAGE", without the line where it is 0.
[[noreturn]] void mesh_error(const MeshText& file, std::size_t line, const std::string& message);

/// A word from a file for a message: printable and short.
std::string in_quotes(std::string_view word);

/// Reads a number at the start of `rest` and moves `rest` behind it; leaves it alone and returns
/// false if there is none. Overflow gives an infinity, underflow 0; "nan", "inf" and what old
/// C libraries wrote for them ("1.#IND") are read as such.
bool take_float(std::string_view& rest, float& value);

/// The same for a whole number; false also if it does not fit.
bool take_integer(std::string_view& rest, std::int64_t& value);

inline bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// The blank-separated words of one line.
class LineWords {
  public:
    LineWords(const MeshText& file, std::string_view line, std::size_t number)
        : m_file(&file), m_rest(line), m_number(number) {}

    /// Next word; empty at the end of the line.
    std::string_view word();
    /// Next word as a number; an error if it is something else or missing.
    float number();
    /// Next word as a number; false at the end of the line or a comment (#), an error if it is
    /// something else.
    bool optional_number(float& value);
    std::int64_t integer();
    /// An error about this line.
    [[noreturn]] void fail(const std::string& message) const;
    [[nodiscard]] std::size_t line_number() const { return m_number; }

  private:
    void skip_blanks();
    [[noreturn]] void fail_expected(std::string_view what);

    const MeshText* m_file;
    std::string_view m_rest;
    std::size_t m_number;
};

/// The lines of a file; one that ends in a backslash goes on in the next.
class LineReader {
  public:
    enum class Continuation { none, backslash };
    LineReader(const MeshText& file, Continuation continuation)
        : m_file(&file), m_continuation(continuation) {}

    /// Moves to the next line; false at the end of the file.
    bool next();
    /// The words of the current line. Valid until `next`.
    [[nodiscard]] LineWords words() const { return {*m_file, m_line, m_first_number}; }
    [[nodiscard]] std::size_t line_number() const { return m_first_number; }
    /// Where the next line begins.
    [[nodiscard]] std::size_t offset() const { return m_offset; }

  private:
    std::string_view physical_line();

    const MeshText* m_file;
    Continuation m_continuation;
    std::size_t m_offset = 0;
    std::size_t m_number = 0;        ///< of the last line taken
    std::size_t m_first_number = 0;  ///< of the line where the current one began
    std::string_view m_line;
    std::string m_joined;
};

}  // namespace burnish
