#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Texts of the three program languages as tokens. Nothing is copied: a token points into the text.
namespace burnish {

struct Token {
    enum class Kind {
        word,          ///< letter or _, then letters, digits, _
        number,        ///< digits with at most one point; a sign is a token of its own
        punctuation,   ///< one of { } ( ) = * . , ; + -
        open_comment,  ///< a /* without its end: all the rest of the text
        unknown,       ///< a run of bytes that begin no token
        end,
    };
    Kind kind = Kind::end;
    std::string_view text;
    /// Of a word that is directly followed by one of .rgb .a .b .r .g: what stands behind the
    /// point.
    std::string_view component;
    std::size_t line = 1;
    std::size_t column = 1;  ///< in bytes

    /// A word without a component or a punctuation mark that reads `what`.
    [[nodiscard]] bool is(std::string_view what) const {
        return (kind == Kind::word || kind == Kind::punctuation) && text == what &&
               component.empty();
    }
};

/// The token for a message: in quotes, cut to 32 bytes, unprintable bytes as \xNN.
std::string quoted(const Token& token);

/// Comments (# and // to the end of the line, /* to */) and white space vanish between tokens.
class Lexer {
  public:
    explicit Lexer(std::string_view text) : m_text(text) {}

    /// Skips a byte-order mark and white space; if `header` comes next, skips that, too.
    bool take_header(std::string_view header);
    /// Everything up to the next white space, as one `unknown`.
    Token take_run();
    /// After the last token, `end` again and again.
    Token next();

  private:
    [[nodiscard]] bool at_end() const { return m_at >= m_text.size(); }
    [[nodiscard]] char peek(std::size_t ahead = 0) const;
    void skip_to(std::size_t end);
    void skip_line();
    bool skip_block_comment();
    bool skip_blanks();
    [[nodiscard]] std::size_t word_end(std::size_t from) const;
    [[nodiscard]] std::size_t number_end() const;
    [[nodiscard]] std::string_view component_at(std::size_t point) const;
    Token token(Token::Kind kind, std::size_t end);

    std::string_view m_text;
    std::size_t m_at = 0;
    std::size_t m_line = 1;
    std::size_t m_line_start = 0;
};

}  // namespace burnish
