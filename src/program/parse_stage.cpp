#include "program/parse_stage.hpp"

#include <fmt/format.h>

#include <array>

#include "program/operand.hpp"

namespace burnish {
namespace {

struct ScaleWord {
    std::string_view name;
    Scale scale;
    bool bias_minus_half;
};
constexpr std::array<ScaleWord, 5> kScaleWords{
    {{"scale_by_one_half", Scale::half, false},
     {"scale_by_two", Scale::two, false},
     {"scale_by_four", Scale::four, false},
     {"bias_by_negative_one_half", Scale::one, true},
     {"bias_by_negative_one_half_scale_by_two", Scale::two, true}}};

const ScaleWord* scale_word(const Token& token) {
    for (const ScaleWord& word : kScaleWords) {
        if (token.is(word.name)) return &word;
    }
    return nullptr;
}

/// The operations of one portion, from '{' to '}'.
class PortionParser {
  public:
    PortionParser(Reader& reader, const Dialect& dialect, Place place, Portion& portion,
                  StageLines lines)
        : m_reader(reader),
          m_dialect(dialect),
          m_place(place),
          m_portion(portion),
          m_lines(lines) {}

    void parse() {
        const std::size_t errors = m_reader.error_count();
        m_reader.expect("{");
        while (!m_reader.at("}") && !m_reader.at_end()) m_reader.statement([this] { statement(); });
        if (m_operations == 0 && errors == m_reader.error_count() && !m_reader.at_end())
            m_reader.complain(m_reader.peek(), "a portion without operations, expected a register");
        m_reader.expect("}");
    }

  private:
    void statement() {
        if (const ScaleWord* word = scale_word(m_reader.peek())) {
            scale(*word);
            return;
        }
        const Token start = m_reader.peek();
        if (m_scaled)
            m_reader.complain(start,
                              fmt::format("{} after the scale, expected '}}'", quoted(start)));
        else if (m_operations == 3)
            m_reader.complain(start, fmt::format("{} begins a fourth operation, expected at most "
                                                 "three",
                                                 quoted(start)));
        // A statement that fails further on was an operation, too.
        m_index = m_operations;
        if (m_operations < 3) ++m_operations;
        note(m_operations, start);
        const Register out = destination();
        m_reader.expect("=");
        if (m_reader.at("mux") || m_reader.at("sum"))
            third(out);
        else
            product(out);
        m_reader.expect_end();
    }

    /// Operations count from 1, as ProgramPlace has them.
    void note(int statement, const Token& begin) {
        m_lines.note(is_scalar(m_place) ? ProgramPlace::Part::alpha : ProgramPlace::Part::rgb,
                     statement, begin);
    }

    void scale(const ScaleWord& word) {
        const Token token = m_reader.take();
        note(ProgramPlace::kScale, token);
        if (m_operations == 0)
            m_reader.complain(
                token,
                fmt::format("{} in front of the operations, expected a register", quoted(token)));
        else if (m_scaled)
            m_reader.complain(token,
                              fmt::format("{} is a second scale, expected '}}'", quoted(token)));
        else
            m_scaled = true;
        m_portion.scale = word.scale;
        m_portion.bias_minus_half = word.bias_minus_half;
        m_reader.expect_empty_call();
    }

    Register destination() {
        const Token token = m_reader.peek();
        const Register out = take_destination(m_reader, m_dialect, m_place);
        const bool twice =
            out != Register::discard && (out == m_portion.ab_out || out == m_portion.cd_out);
        if (twice)
            m_reader.complain(token, fmt::format("{} is written twice in one portion", token.text));
        return twice ? Register::discard : out;
    }

    void third(Register out) {
        const Token token = m_reader.take();
        const bool dot =
            m_portion.ab_product == Product::dot || m_portion.cd_product == Product::dot;
        if (m_index < 2)
            m_reader.complain(token, fmt::format("{}() after {} product{}, expected two of them",
                                                 token.text, m_index, m_index == 1 ? "" : "s"));
        else if (dot && !m_dialect.extended)
            m_reader.complain(token, fmt::format("{}() of a dot product, which {} cannot say",
                                                 token.text, m_dialect.header));
        m_portion.third = token.text == "mux" ? Third::mux : Third::sum;
        m_portion.third_out = out;
        m_reader.expect("(");
        m_reader.expect(")");
    }

    void product(Register out) {
        const Token start = m_reader.peek();
        if (m_index == 2)
            m_reader.complain(
                start,
                fmt::format("{} begins a third product, expected mux() or sum()", quoted(start)));
        const Input x = take_operand(m_reader, m_dialect, m_place).input;
        Input y{Register::zero, Mapping::unsigned_invert,
                is_scalar(m_place) ? Component::alpha : Component::rgb};
        Product kind = Product::multiply;
        const Token sign = m_reader.peek();
        if (m_reader.at("*") || m_reader.at(".")) {
            if (m_reader.take().text == ".") kind = Product::dot;
            y = take_operand(m_reader, m_dialect, m_place).input;
        } else if (!m_reader.at_statement_end()) {
            m_reader.fail(is_scalar(m_place) ? "'*' or ';'" : "'*', '.' or ';'");
        }
        if (kind == Product::dot && is_scalar(m_place))
            m_reader.complain(sign, "a dot product in an alpha portion, expected '*'");
        set_product(x, y, kind, out);
    }

    void set_product(const Input& x, const Input& y, Product kind, Register out) {
        const bool first = m_index == 0;
        (first ? m_portion.a : m_portion.c) = x;
        (first ? m_portion.b : m_portion.d) = y;
        (first ? m_portion.ab_product : m_portion.cd_product) = kind;
        (first ? m_portion.ab_out : m_portion.cd_out) = out;
    }

    Reader& m_reader;
    const Dialect& m_dialect;
    Place m_place;
    Portion& m_portion;
    StageLines m_lines;
    int m_operations = 0;  ///< begun so far, at most 3
    int m_index = 0;       ///< of the current one; 3 if there are too many
    bool m_scaled = false;
};

/// Constants and portions of one stage, from '{' to '}'.
class StageParser {
  public:
    StageParser(Reader& reader, const Dialect& dialect, StageLines lines)
        : m_reader(reader), m_dialect(dialect), m_lines(lines) {}

    GeneralStage parse() {
        const std::size_t errors = m_reader.error_count();
        m_lines.note(ProgramPlace::Part::stage, ProgramPlace::kAll, m_reader.peek());
        m_reader.expect("{");
        while (!m_reader.at("}") && !m_reader.at_end()) m_reader.statement([this] { statement(); });
        const bool empty = !m_rgb && !m_alpha;
        if (empty && errors == m_reader.error_count() && !m_reader.at_end())
            m_reader.complain(m_reader.peek(), "a stage without portions, expected rgb or alpha");
        m_reader.expect("}");
        return m_stage;
    }

  private:
    void statement() {
        constexpr std::array<std::string_view, 5> kWords{"rgb", "alpha", "const0", "const1",
                                                         "wide"};
        if (m_reader.at("const0"))
            constant(m_stage.const0);
        else if (m_reader.at("const1"))
            constant(m_stage.const1);
        else if (m_reader.at("wide") || m_reader.at("rgb") || m_reader.at("alpha"))
            portion();
        else
            fail_word(m_reader, "rgb, alpha, const0, const1 or '}'", kWords);
    }

    void constant(std::optional<glm::vec4>& target) {
        m_lines.note(ProgramPlace::Part::constants, ProgramPlace::kAll, m_reader.peek());
        if (m_rgb || m_alpha)
            m_reader.complain(m_reader.peek(),
                              fmt::format("{} after a portion, expected it in front of them",
                                          m_reader.peek().text));
        const bool taken = target.has_value();
        target = parse_constant(m_reader, taken);
    }

    void portion() {
        const Token first = m_reader.peek();
        const bool wide = m_reader.take_if("wide");
        if (wide && !m_dialect.extended)
            m_reader.complain(first, fmt::format("wide in {}, it is a word of {}", m_dialect.header,
                                                 kBrn10.header));
        if (!m_reader.at("rgb") && !m_reader.at("alpha")) m_reader.fail("rgb or alpha");
        const Token name = m_reader.take();
        const bool alpha = name.text == "alpha";
        bool& seen = alpha ? m_alpha : m_rgb;
        if (seen)
            m_reader.complain(name, fmt::format("a second {} portion in one stage", name.text));
        seen = true;
        Portion& target = alpha ? m_stage.alpha : m_stage.rgb;
        target = alpha ? idle_stage().alpha : Portion{};
        target.wide = wide;
        m_lines.note(alpha ? ProgramPlace::Part::alpha : ProgramPlace::Part::rgb,
                     ProgramPlace::kAll, first);
        PortionParser(m_reader, m_dialect, alpha ? Place::alpha : Place::rgb, target, m_lines)
            .parse();
    }

    Reader& m_reader;
    const Dialect& m_dialect;
    StageLines m_lines;
    GeneralStage m_stage = idle_stage();
    bool m_rgb = false;
    bool m_alpha = false;
};

}  // namespace

glm::vec4 parse_constant(Reader& reader, bool taken) {
    const Token name = reader.take();
    if (taken) reader.complain(name, fmt::format("{} is set twice", name.text));
    reader.expect("=");
    reader.expect("(");
    glm::vec4 value{0.0F};
    for (int i = 0; i < 4; ++i) {
        if (i > 0) reader.expect(",");
        const Token token = reader.peek();
        value[i] = reader.number();
        if (!(value[i] >= 0.0F && value[i] <= 1.0F))
            reader.complain(token, fmt::format("a component of {} is {}, expected 0 .. 1",
                                               name.text, value[i]));
    }
    reader.expect(")");
    reader.expect_end();
    return value;
}

GeneralStage parse_stage(Reader& reader, const Dialect& dialect, StageLines lines) {
    return StageParser(reader, dialect, lines).parse();
}

}  // namespace burnish
