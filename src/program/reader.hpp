#pragma once

#include <array>
#include <burnish/program_text.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/lexer.hpp"

namespace burnish {

/// The tokens of a text, one ahead, and the errors found in it so far.
///
/// Two kinds of errors: complain() notes one and lets parsing go on at the same place; fail() and
/// expect() also leave the statement, by an exception that statement() catches. So a parser is
/// written as if texts were right.
class Reader {
  public:
    explicit Reader(std::string_view text) : m_lexer(text) {}

    /// The header that the text begins with; none, with an error noted, if it is not one of those.
    std::optional<std::string_view> header(std::span<const std::string_view> known);

    [[nodiscard]] const Token& peek() const { return m_token; }
    [[nodiscard]] bool at(std::string_view what) const { return m_token.is(what); }
    [[nodiscard]] bool at_end() const {
        return m_token.kind == Token::Kind::end || m_token.kind == Token::Kind::open_comment;
    }
    Token take();
    bool take_if(std::string_view what);
    /// Takes the mark or word `what`, or fails.
    void expect(std::string_view what);
    /// Takes a number with an optional sign. Too large for a float: complains, gives 0.
    float number();
    /// At ';', or where the next statement seems to begin: on another line.
    [[nodiscard]] bool at_statement_end() const;
    /// Takes the ';' of a statement; where it is missing at the end of a line, complains and goes
    /// on.
    void expect_end();
    /// name() without arguments and the rest of its statement, after the name.
    void expect_empty_call();

    /// Notes an error at `where`; one per place.
    void complain(const Token& where, std::string message);
    /// The next token is not what it should be: "found 'x', expected y".
    [[noreturn]] void fail(std::string_view expected);
    /// The next token should be one of `words`; a word that is none of `vocabulary` is called
    /// unrecognized, with the nearest of `words` if there is one.
    [[noreturn]] void fail(std::string_view expected, std::span<const std::string_view> words,
                           std::span<const std::string_view> vocabulary);

    /// Runs `parse`; after a failure goes on behind the statement: after the next ';' or block, or
    /// before the '}' that closes the block around it. At least one token is consumed.
    template <class Parse>
    void statement(const Parse& parse) {
        const std::size_t before = m_taken;
        try {
            parse();
        } catch (const Skip&) {
            skip_statement();
        }
        if (m_taken == before) take();
    }
    /// Runs `parse`, which reads the whole text. What comes after kMaxTextErrors is not looked at.
    template <class Parse>
    void text(const Parse& parse) {
        try {
            parse();
        } catch (const TooManyErrors&) {
        }
    }

    [[nodiscard]] bool failed() const { return !m_errors.empty(); }
    [[nodiscard]] std::size_t error_count() const { return m_errors.size(); }
    /// In the order of the text.
    std::vector<TextError> take_errors();

  private:
    struct Skip {};
    struct TooManyErrors {};
    void skip_statement();

    Lexer m_lexer;
    Token m_token;
    std::size_t m_taken = 0;
    std::size_t m_taken_line = 0;
    std::vector<TextError> m_errors;
};

}  // namespace burnish
