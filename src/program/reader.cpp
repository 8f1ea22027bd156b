#include "program/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "core/nearest.hpp"

namespace burnish {

std::optional<std::string_view> Reader::header(std::span<const std::string_view> known) {
    for (const std::string_view header : known) {
        if (!m_lexer.take_header(header)) continue;
        m_token = m_lexer.next();
        return header;
    }
    m_token = m_lexer.take_run();
    complain(m_token, fmt::format("the text begins with {}, expected the header {}",
                                  quoted(m_token), fmt::join(known, " or ")));
    return std::nullopt;
}

Token Reader::take() {
    const Token taken = m_token;
    m_token = m_lexer.next();
    ++m_taken;
    m_taken_line = taken.line;
    return taken;
}

bool Reader::take_if(std::string_view what) {
    if (!at(what)) return false;
    take();
    return true;
}

void Reader::expect(std::string_view what) {
    if (!take_if(what)) fail(fmt::format("'{}'", what));
}

bool Reader::at_statement_end() const {
    const bool begins = m_token.kind == Token::Kind::word || at("}") || at("{");
    return at(";") || (begins && m_token.line > m_taken_line);
}

void Reader::expect_end() {
    if (at_statement_end() && !at(";"))
        complain(m_token, fmt::format("found {}, expected ';' in front of it", quoted(m_token)));
    else
        expect(";");
}

void Reader::expect_empty_call() {
    expect("(");
    expect(")");
    expect_end();
}

float Reader::number() {
    const bool negative = at("-");
    if (negative || at("+")) take();
    if (m_token.kind != Token::Kind::number) fail("a number");
    const Token token = take();
    float value = 0.0F;
    const char* const end = token.text.data() + token.text.size();
    const auto result = std::from_chars(token.text.data(), end, value, std::chars_format::fixed);
    if (result.ec == std::errc::result_out_of_range) {
        // Too small becomes 0, too large is an error: a digit before the point tells which.
        value = 0.0F;
        if (token.text.find_first_not_of('0') < token.text.find('.'))
            complain(token, fmt::format("{} is too large for a float", quoted(token)));
    }
    return negative ? -value : value;
}

void Reader::complain(const Token& where, std::string message) {
    if (!m_errors.empty() && m_errors.back().line == where.line &&
        m_errors.back().column == where.column)
        return;
    m_errors.push_back({where.line, where.column, std::move(message)});
    if (m_errors.size() == kMaxTextErrors) throw TooManyErrors();
}

std::vector<TextError> Reader::take_errors() {
    std::stable_sort(m_errors.begin(), m_errors.end(), [](const TextError& a, const TextError& b) {
        return std::pair(a.line, a.column) < std::pair(b.line, b.column);
    });
    return std::move(m_errors);
}

void Reader::fail(std::string_view expected) {
    if (m_token.kind == Token::Kind::unknown)
        complain(m_token,
                 fmt::format("unrecognized token {}, expected {}", quoted(m_token), expected));
    else if (m_token.kind == Token::Kind::open_comment)
        complain(m_token, "the text ends in a comment, expected '*/'");
    else
        complain(m_token, fmt::format("found {}, expected {}", quoted(m_token), expected));
    throw Skip();
}

void Reader::fail(std::string_view expected, std::span<const std::string_view> words,
                  std::span<const std::string_view> vocabulary) {
    const bool known =
        std::find(vocabulary.begin(), vocabulary.end(), m_token.text) != vocabulary.end() ||
        std::find(words.begin(), words.end(), m_token.text) != words.end();
    if (m_token.kind != Token::Kind::word || known) fail(expected);
    const std::string_view near = nearest_name(m_token.text, words);
    complain(m_token,
             near.empty()
                 ? fmt::format("unrecognized token {}, expected {}", quoted(m_token), expected)
                 : fmt::format("unrecognized token {}, did you mean '{}'?", quoted(m_token), near));
    throw Skip();
}

void Reader::skip_statement() {
    for (std::size_t depth = 0; !at_end(); take()) {
        if (depth == 0 && at("}")) return;
        const bool ends = (depth == 0 && at(";")) || (depth == 1 && at("}"));
        if (at("{")) ++depth;
        if (depth > 0 && at("}")) --depth;
        if (!ends) continue;
        take();
        return;
    }
}

}  // namespace burnish
