#include "program/operand.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>

namespace burnish {
namespace {

/// The words of the languages that are no registers.
constexpr std::array<std::string_view, 24> kVocabulary{
    "rgb",
    "alpha",
    "wide",
    "fetch",
    "mux",
    "sum",
    "lerp",
    "out",
    "one",
    "unsigned",
    "unsigned_invert",
    "expand",
    "half_bias",
    "scale_by_one_half",
    "scale_by_two",
    "scale_by_four",
    "bias_by_negative_one_half",
    "bias_by_negative_one_half_scale_by_two",
    "clamp_color_sum",
    "table_1d",
    "table_2d",
    "table_3d",
    "table_cube_map",
    "table_rectangle",
};

/// For suggestions; tex4 and later ones are near enough to tex3.
constexpr std::array<std::string_view, 16> kRegisterWords{
    "zero", "one",  "const0", "const1", "fog",    "col0",      "col1",          "tex0",
    "tex1", "tex2", "tex3",   "spare0", "spare1", "color_sum", "final_product", "discard"};

std::optional<Register> register_named(std::string_view name) {
    for (int i = 0; i <= static_cast<int>(Register::discard); ++i) {
        if (register_name(static_cast<Register>(i)) == name) return static_cast<Register>(i);
    }
    return std::nullopt;
}

bool is_pseudo(Register reg) {
    return reg == Register::color_sum || reg == Register::final_product;
}

const char* name_of(Place place) {
    switch (place) {
        case Place::rgb:
            return "an rgb portion";
        case Place::alpha:
            return "an alpha portion";
        case Place::final_rgb:
            return "an rgb input of the final combiner";
        case Place::final_alpha:
            return "out.a";
    }
    return "";
}

struct MappingWord {
    std::string_view name;
    Mapping plain;
    std::optional<Mapping> negated;  ///< behind a minus
};
constexpr std::array<MappingWord, 4> kMappingWords{
    {{"unsigned", Mapping::unsigned_identity, std::nullopt},
     {"unsigned_invert", Mapping::unsigned_invert, std::nullopt},
     {"expand", Mapping::expand, Mapping::expand_negate},
     {"half_bias", Mapping::half_bias, Mapping::half_bias_negate}}};

const MappingWord* mapping_word(const Token& token) {
    for (const MappingWord& word : kMappingWords) {
        if (token.is(word.name)) return &word;
    }
    return nullptr;
}

/// The mapping of zero that has the value of `mapping` of one.
Mapping mapping_of_one(Mapping mapping) {
    switch (mapping) {
        case Mapping::unsigned_identity:
        case Mapping::signed_identity:
        case Mapping::expand:
            return Mapping::unsigned_invert;
        case Mapping::unsigned_invert:
            return Mapping::unsigned_identity;
        case Mapping::signed_negate:
        case Mapping::expand_negate:
            return Mapping::expand;
        case Mapping::half_bias:
            return Mapping::half_bias_negate;
        case Mapping::half_bias_negate:
            return Mapping::half_bias;
    }
    return mapping;
}

/// Reads one operand of a place.
class OperandParser {
  public:
    OperandParser(Reader& reader, const Dialect& dialect, Place place)
        : m_reader(reader), m_dialect(dialect), m_place(place) {}

    Operand parse() {
        const Token sign = m_reader.peek();
        const bool negative = m_reader.take_if("-");
        const Token function = m_reader.peek();
        const MappingWord* word = mapping_word(function);
        if (word != nullptr) {
            m_reader.take();
            m_reader.expect("(");
        }
        const NamedRegister named = take_register(m_reader, m_dialect);
        if (word != nullptr) m_reader.expect(")");

        Operand operand{{named.reg, Mapping::unsigned_identity, component(named)}, named.token};
        if (is_final(m_place))
            operand.input.mapping = final_mapping(sign, negative, function, word, named.one);
        else
            operand.input.mapping = general_mapping(sign, negative, word);
        if (named.one) operand.input.mapping = mapping_of_one(operand.input.mapping);
        check_readable(operand);
        return operand;
    }

  private:
    Mapping general_mapping(const Token& sign, bool negative, const MappingWord* word) {
        if (word == nullptr) return negative ? Mapping::signed_negate : Mapping::signed_identity;
        if (!negative) return word->plain;
        if (!word->negated)
            m_reader.complain(sign, fmt::format("minus in front of {}, expected it in front of "
                                                "expand, half_bias or a register",
                                                word->name));
        return word->negated.value_or(word->plain);
    }

    Mapping final_mapping(const Token& sign, bool negative, const Token& function,
                          const MappingWord* word, bool one) {
        if (negative && one && word == nullptr)
            m_reader.complain(sign,
                              "-one needs expand(zero), which the final combiner does not have");
        else if (negative)
            m_reader.complain(sign,
                              "minus in the final combiner, expected a register, unsigned or "
                              "unsigned_invert");
        if (word == nullptr) return Mapping::unsigned_identity;
        if (word->negated)
            m_reader.complain(function, fmt::format("{} in the final combiner, expected unsigned "
                                                    "or unsigned_invert",
                                                    word->name));
        return word->plain;
    }

    Component component(const NamedRegister& named) {
        const Component own = is_scalar(m_place) ? Component::alpha : Component::rgb;
        const std::string_view written = named.token.component;
        if (written.empty()) return own;
        const std::string_view other = is_scalar(m_place) ? "b" : "rgb";
        if (written != "a" && written != other)
            m_reader.complain(
                named.token,
                fmt::format("component .{} of {} in {}, expected {}", written, named.token.text,
                            name_of(m_place), is_scalar(m_place) ? ".a or .b" : ".rgb or .a"));
        if (named.reg == Register::zero) return own;
        if (written == "a") return Component::alpha;
        return is_scalar(m_place) ? Component::blue : Component::rgb;
    }

    void check_readable(const Operand& operand) {
        const Register reg = operand.input.reg;
        if (reg == Register::discard)
            m_reader.complain(operand.token, "discard is read, it can only be written");
        if (is_pseudo(reg) && !is_final(m_place))
            m_reader.complain(operand.token,
                              fmt::format("{} in a general stage, only the final combiner has it",
                                          operand.token.text));
        if (is_pseudo(reg) && is_final(m_place) && operand.input.component != Component::rgb)
            m_reader.complain(operand.token,
                              fmt::format("{} as alpha, it has only rgb", operand.token.text));
        if (reg == Register::fog && operand.input.component == Component::alpha &&
            !is_final(m_place))
            m_reader.complain(
                operand.token,
                "the alpha of fog in a general stage, only the final combiner has it");
    }

    Reader& m_reader;
    const Dialect& m_dialect;
    Place m_place;
};

}  // namespace

void fail_word(Reader& reader, std::string_view expected, std::span<const std::string_view> words) {
    const bool known = register_named(reader.peek().text).has_value();
    if (known) reader.fail(expected);
    reader.fail(expected, words, kVocabulary);
}

NamedRegister take_register(Reader& reader, const Dialect& dialect) {
    const bool word = reader.peek().kind == Token::Kind::word;
    if (word && reader.peek().text == "one") return {Register::zero, true, reader.take()};
    const std::optional<Register> reg = word ? register_named(reader.peek().text) : std::nullopt;
    if (!reg) fail_word(reader, "a register", kRegisterWords);
    const NamedRegister named{*reg, false, reader.take()};
    const int unit = static_cast<int>(*reg) - static_cast<int>(Register::tex0);
    if (*reg <= Register::tex15 && unit >= dialect.units)
        reader.complain(named.token,
                        fmt::format("{} in {}, which has tex0 .. tex{}", quoted(named.token),
                                    dialect.header, dialect.units - 1));
    return named;
}

Operand take_operand(Reader& reader, const Dialect& dialect, Place place) {
    return OperandParser(reader, dialect, place).parse();
}

Register take_destination(Reader& reader, const Dialect& dialect, Place place) {
    const NamedRegister named = take_register(reader, dialect);
    const bool writable = named.reg >= Register::col0 && !is_pseudo(named.reg);
    if (!writable)
        reader.complain(named.token,
                        fmt::format("{} is written, it is read-only", named.token.text));
    const std::string_view own = is_scalar(place) ? "a" : "rgb";
    if (!named.token.component.empty() && named.token.component != own)
        reader.complain(named.token, fmt::format("component .{} written in {}, expected .{}",
                                                 named.token.component, name_of(place), own));
    return writable ? named.reg : Register::discard;
}

}  // namespace burnish
