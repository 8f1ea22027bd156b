#include "program/lexer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace burnish {
namespace {

constexpr std::string_view kBlanks = " \t\n\r\f\v";
constexpr std::string_view kPunctuation = "{}()=*.,;+-";

// Not those of <cctype>: they depend on the locale.
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool begins_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_blank(char c) {
    return kBlanks.find(c) != std::string_view::npos;
}
bool begins_token(char c) {
    return begins_word(c) || is_digit(c) || is_blank(c) || c == '#' || c == '/' ||
           kPunctuation.find(c) != std::string_view::npos;
}

}  // namespace

std::string quoted(const Token& token) {
    if (token.kind == Token::Kind::end) return "the end of the text";
    constexpr std::size_t kLongest = 32;
    std::string text = "'";
    for (const char c : token.text.substr(0, kLongest)) {
        if (c >= 0x20 && c < 0x7F)
            text += c;
        else
            text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
    if (token.text.size() > kLongest) text += "...";
    if (!token.component.empty()) text += fmt::format(".{}", token.component);
    return text + "'";
}

/// The text's byte there, 0 behind its end.
char Lexer::peek(std::size_t ahead) const {
    return ahead < m_text.size() - m_at ? m_text[m_at + ahead] : '\0';
}

void Lexer::skip_to(std::size_t end) {
    for (; m_at < end; ++m_at) {
        if (m_text[m_at] != '\n') continue;
        ++m_line;
        m_line_start = m_at + 1;
    }
}

void Lexer::skip_line() {
    m_at = std::min(m_text.find('\n', m_at), m_text.size());
}

/// False, without a move, if the comment has no end.
bool Lexer::skip_block_comment() {
    const std::size_t close = m_text.find("*/", m_at + 2);
    if (close == std::string_view::npos) return false;
    skip_to(close + 2);
    return true;
}

/// Also skips comments. False in front of a block comment without an end.
bool Lexer::skip_blanks() {
    while (!at_end()) {
        if (is_blank(peek())) {
            skip_to(m_at + 1);
        } else if (peek() == '#' || (peek() == '/' && peek(1) == '/')) {
            skip_line();
        } else if (peek() == '/' && peek(1) == '*') {
            if (!skip_block_comment()) return false;
        } else {
            break;
        }
    }
    return true;
}

bool Lexer::take_header(std::string_view header) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (m_at == 0 && m_text.starts_with(kByteOrderMark)) m_at = m_line_start = 3;
    while (!at_end() && is_blank(peek())) skip_to(m_at + 1);
    if (!m_text.substr(m_at).starts_with(header)) return false;
    m_at += header.size();
    return true;
}

std::size_t Lexer::word_end(std::size_t from) const {
    std::size_t end = from;
    while (end < m_text.size() && (begins_word(m_text[end]) || is_digit(m_text[end]))) ++end;
    return end;
}

std::size_t Lexer::number_end() const {
    std::size_t end = m_at;
    for (bool point = false; end < m_text.size(); ++end) {
        if (m_text[end] == '.' && !point)
            point = true;
        else if (!is_digit(m_text[end]))
            break;
    }
    return end;
}

/// The component behind a point at `point`; empty if there is none.
std::string_view Lexer::component_at(std::size_t point) const {
    constexpr std::array<std::string_view, 5> kComponents{"rgb", "a", "b", "r", "g"};
    if (point >= m_text.size() || m_text[point] != '.') return {};
    const std::string_view word = m_text.substr(point + 1, word_end(point + 1) - point - 1);
    return std::find(kComponents.begin(), kComponents.end(), word) == kComponents.end()
               ? std::string_view{}
               : word;
}

Token Lexer::token(Token::Kind kind, std::size_t end) {
    Token token;
    token.kind = kind;
    token.text = m_text.substr(m_at, end - m_at);
    token.line = m_line;
    token.column = m_at - m_line_start + 1;
    skip_to(end);
    return token;
}

Token Lexer::take_run() {
    if (at_end()) return token(Token::Kind::end, m_at);
    std::size_t end = m_at;
    while (end < m_text.size() && !is_blank(m_text[end])) ++end;
    return token(Token::Kind::unknown, end);
}

Token Lexer::next() {
    if (!skip_blanks()) return token(Token::Kind::open_comment, m_text.size());
    if (at_end()) return token(Token::Kind::end, m_at);
    const char c = peek();
    if (begins_word(c)) {
        const std::size_t end = word_end(m_at);
        Token word = token(Token::Kind::word, end);
        word.component = component_at(end);
        if (!word.component.empty()) m_at += 1 + word.component.size();
        return word;
    }
    if (is_digit(c) || (c == '.' && is_digit(peek(1))))
        return token(Token::Kind::number, number_end());
    if (kPunctuation.find(c) != std::string_view::npos)
        return token(Token::Kind::punctuation, m_at + 1);
    std::size_t end = m_at + 1;  // a lone / is unknown, too
    while (end < m_text.size() && !begins_token(m_text[end])) ++end;
    return token(Token::Kind::unknown, end);
}

}  // namespace burnish
