#include <fmt/format.h>

#include <array>
#include <burnish/program_text.hpp>
#include <utility>

#include "program/reader.hpp"
#include "program/texture_words.hpp"

namespace burnish {
namespace {

constexpr std::string_view kGreater = "GEQUAL_TO_ZERO";
constexpr std::string_view kLess = "LESS_THAN_ZERO";

/// One statement per unit, in order.
class TextureShaderParser {
  public:
    TextureShaderParser(Reader& reader, TextureShader& shader)
        : m_reader(reader), m_shader(shader) {}

    void parse() {
        while (!m_reader.at_end()) {
            m_known = false;
            m_begun = m_reader.peek().kind == Token::Kind::word;
            if (m_begun && m_unit == kUnits) {
                complain_of_fifth();
                break;
            }
            m_reader.statement([this] { statement(); });
            if (m_begun) end_statement();
        }
        if (m_reader.peek().kind == Token::Kind::open_comment)
            m_reader.complain(m_reader.peek(), "the text ends in a comment, expected '*/'");
        if (m_group.group != nullptr)
            m_reader.complain(m_group_token,
                              fmt::format("the next stage of {} is missing, expected {}",
                                          quoted(m_group_token), next_of_group()));
    }

  private:
    void statement() {
        const Token token = m_reader.peek();
        const TextureWord word = take_word();
        m_word = word;
        m_known = true;
        check_sequence(token, word);
        check_place(token, word.operation);
        m_token = token;
        TextureUnit unit;
        unit.operation = word.operation;
        m_reader.expect("(");
        arguments(word, unit);
        m_reader.expect(")");
        m_reader.expect_end();
        m_shader.units.at(m_unit) = unit;
    }

    /// Whatever follows has no unit.
    void complain_of_fifth() {
        m_reader.complain(m_reader.peek(),
                          fmt::format("{} begins a fifth statement, there are {} units",
                                      quoted(m_reader.peek()), kUnits));
    }

    /// What the statement, right or wrong, means for the next one. After a wrong one, anything may
    /// follow.
    void end_statement() {
        const bool open =
            m_known && m_word.group != nullptr && m_word.index + 1 < m_word.group->count;
        m_group = open ? m_word : TextureWord{};
        m_group_token = m_token;
        m_lost = !m_known;
        m_readable.at(m_unit++) = !m_known || has_output(m_word.operation);
    }

    TextureWord take_word() {
        const Token& token = m_reader.peek();
        const bool word = token.kind == Token::Kind::word && token.component.empty();
        const std::optional<TextureWord> known = word ? texture_word(token.text) : std::nullopt;
        if (!known) {
            const std::vector<std::string> owned = texture_words();
            const std::vector<std::string_view> words(owned.begin(), owned.end());
            m_reader.fail("a texture operation such as texture_2d", words, kVocabulary);
        }
        m_reader.take();
        return *known;
    }

    std::string next_of_group() const { return group_word(*m_group.group, m_group.index + 1); }

    void check_sequence(const Token& token, const TextureWord& word) {
        const bool goes_on = m_group.group != nullptr && word.group == m_group.group &&
                             word.index == m_group.index + 1;
        if (goes_on) return;
        if (m_group.group != nullptr) {
            m_reader.complain(token,
                              fmt::format("{} does not match the previous stage {}, expected "
                                          "{}",
                                          quoted(token), quoted(m_group_token), next_of_group()));
        } else if (word.group != nullptr && word.index > 0 && !m_lost) {
            m_reader.complain(token,
                              fmt::format("the previous stage of {} is missing, expected {} in "
                                          "front of it",
                                          quoted(token), group_word(*word.group, word.index - 1)));
        }
    }

    void check_place(const Token& token, TextureOperation operation) {
        if (operation == TextureOperation::texture_brdf) check_brdf(token);
        if (!replaces_depth(operation)) return;
        if (std::exchange(m_replaces_depth, true))
            m_reader.complain(token, fmt::format("{} replaces the depth, as an earlier unit does",
                                                 quoted(token)));
    }

    void check_brdf(const Token& token) {
        const bool ready = m_unit >= 2 && m_readable[m_unit - 1] && m_readable[m_unit - 2];
        if (!ready)
            m_reader.complain(token, fmt::format("{} in unit {}, expected two units with an output "
                                                 "in front of it",
                                                 quoted(token), m_unit));
    }

    void arguments(const TextureWord& word, TextureUnit& unit) {
        switch (arguments_of(word.operation)) {
            case TextureArguments::none:
                return;
            case TextureArguments::previous:
                unit.previous = reference();
                return;
            case TextureArguments::offset:
                offset(unit);
                return;
            case TextureArguments::offset_scale:
                offset(unit);
                unit.offset_scale = next_number();
                unit.offset_bias = next_number();
                return;
            case TextureArguments::dot:
                dot(word, unit);
                return;
            case TextureArguments::cull:
                cull(unit);
                return;
        }
    }

    float next_number() {
        m_reader.expect(",");
        return m_reader.number();
    }

    void offset(TextureUnit& unit) {
        unit.previous = reference();
        for (int i = 0; i < 4; ++i) unit.offset_matrix[i / 2][i % 2] = next_number();
    }

    void dot(const TextureWord& word, TextureUnit& unit) {
        const bool expand = m_reader.at("expand");
        const bool force = m_reader.at("force_blue_to_one");
        if (expand) unit.dot_mapping = DotMapping::expand;
        if (force) unit.dot_mapping = DotMapping::force_blue_to_one;
        if (expand || force) {
            m_reader.take();
            m_reader.expect("(");
        }
        unit.previous = reference();
        if (expand || force) m_reader.expect(")");
        if (word.group == nullptr || !word.group->const_eye) return;
        if (word.begins_group()) {
            for (int i = 0; i < 3; ++i) m_eye[i] = next_number();
        } else if (word.index + 1 == word.group->count) {
            unit.const_eye = m_eye;
        }
    }

    void cull(TextureUnit& unit) {
        for (std::size_t i = 0; i < unit.cull.size(); ++i) {
            if (i > 0) m_reader.expect(",");
            if (m_reader.take_if(kLess))
                unit.cull[i] = CullTest::less_than_zero;
            else if (!m_reader.take_if(kGreater))
                m_reader.fail(fmt::format("{} or {}", kGreater, kLess), std::array{kGreater, kLess},
                              kVocabulary);
        }
    }

    /// Takes tex0, tex1 or tex2; complains unless it is an earlier unit with an output.
    int reference() {
        constexpr std::array<std::string_view, 4> kRegisters{"tex0", "tex1", "tex2", "tex3"};
        std::size_t unit = 0;
        while (unit < kRegisters.size() && !m_reader.at(kRegisters[unit])) ++unit;
        if (unit == kRegisters.size())
            m_reader.fail("tex0, tex1 or tex2", std::span(kRegisters).first(3), kVocabulary);
        const Token token = m_reader.take();
        if (unit == 3)
            m_reader.complain(token, "tex3 is referred to, expected tex0, tex1 or tex2");
        else if (unit == m_unit)
            m_reader.complain(token, fmt::format("unit {} refers to itself, expected an earlier "
                                                 "unit",
                                                 unit));
        else if (unit > m_unit)
            m_reader.complain(token, fmt::format("{} is not ready in unit {}, expected an earlier "
                                                 "unit",
                                                 token.text, m_unit));
        else if (!m_readable[unit])
            m_reader.complain(token,
                              fmt::format("{} has no output, its operation is {}", token.text,
                                          texture_operation_name(m_shader.units[unit].operation)));
        else
            return static_cast<int>(unit);
        return 0;
    }

    static constexpr std::size_t kUnits = kTextureShaderUnits;
    static constexpr std::array<std::string_view, 8> kVocabulary{
        "tex0", "tex1", "tex2", "tex3", "expand", "force_blue_to_one", kGreater, kLess};

    Reader& m_reader;
    TextureShader& m_shader;
    std::size_t m_unit = 0;
    bool m_replaces_depth = false;
    std::array<bool, kUnits> m_readable{};
    // The current statement.
    bool m_begun = false;  ///< it begins with a word
    bool m_known = false;  ///< which is one of the language
    TextureWord m_word;
    Token m_token;
    // The one before it.
    TextureWord m_group;  ///< no group: nothing has to follow
    Token m_group_token;
    bool m_lost = false;  ///< it was not understood
    glm::vec3 m_eye{0.0F};
};

}  // namespace

Parsed<TextureShader> parse_texture_shader(std::string_view text) {
    constexpr std::array<std::string_view, 1> kHeaders{"!!TS1.0"};
    Reader reader(text);
    TextureShader shader;
    reader.text([&] {
        if (reader.header(kHeaders)) TextureShaderParser(reader, shader).parse();
    });
    if (reader.failed()) return {std::nullopt, reader.take_errors(), {}};
    return {shader, {}, {}};
}

}  // namespace burnish
