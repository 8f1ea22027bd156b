#include "program/parse_final.hpp"

#include <fmt/format.h>

#include <utility>

namespace burnish {
namespace {

constexpr Input kOne{Register::zero, Mapping::unsigned_invert, Component::rgb};

bool is_color_sum(const Input& input) {
    return input.reg == Register::color_sum;
}

}  // namespace

/// Takes the first word of a statement that may stand once.
Token FinalParser::begin(bool& seen) {
    const Token name = m_reader.take();
    if (seen) m_reader.complain(name, fmt::format("a second {}", quoted(name)));
    seen = true;
    return name;
}

/// The same, one that ProgramPlace names.
Token FinalParser::begin(bool& seen, std::uint8_t statement) {
    const Token name = begin(seen);
    m_lines.emplace(ProgramPlace{ProgramPlace::Part::final_combiner, 0, statement}, name.line);
    return name;
}

Operand FinalParser::operand(Place place) {
    const Operand operand = take_operand(m_reader, m_dialect, place);
    if (operand.input.reg == Register::final_product && !m_product_use)
        m_product_use = operand.token;
    return operand;
}

void FinalParser::clamp_color_sum() {
    begin(m_clamps);
    m_reader.expect_empty_call();
    m_final.clamp_color_sum = true;
}

void FinalParser::product_factor(Input& target) {
    const Operand factor = take_operand(m_reader, m_dialect, Place::final_rgb);
    if (is_color_sum(factor.input))
        m_reader.complain(factor.token, "color_sum in final_product, expected another register");
    if (factor.input.reg == Register::final_product)
        m_reader.complain(factor.token, "final_product refers to itself");
    target = factor.input;
}

void FinalParser::final_product() {
    begin(m_has_product, ProgramPlace::kFinalProduct);
    m_reader.expect("=");
    product_factor(m_final.e);
    m_reader.expect("*");
    product_factor(m_final.f);
    m_reader.expect_end();
}

void FinalParser::lerp() {
    m_reader.take();
    m_reader.expect("(");
    const Operand weight = operand(Place::final_rgb);
    if (is_color_sum(weight.input))
        m_reader.complain(weight.token,
                          "color_sum as the weight of lerp, expected another register");
    m_reader.expect(",");
    m_final.a = weight.input;
    m_final.b = operand(Place::final_rgb).input;
    m_reader.expect(",");
    m_final.c = operand(Place::final_rgb).input;
    m_reader.expect(")");
}

/// The colour sum cannot be A, but products commute.
void FinalParser::product(const Operand& x, const Operand& y) {
    m_final.a = x.input;
    m_final.b = y.input;
    if (!is_color_sum(x.input)) return;
    std::swap(m_final.a, m_final.b);
    if (is_color_sum(y.input))
        m_reader.complain(y.token, "color_sum times color_sum, expected it once");
}

/// x * 1 + y, or 1 * x + y for the colour sum, which cannot be A.
void FinalParser::sum(const Input& x, const Input& y) {
    m_final.a = x;
    m_final.b = kOne;
    if (is_color_sum(x)) std::swap(m_final.a, m_final.b);
    m_final.d = y;
}

void FinalParser::out_rgb() {
    begin(m_has_rgb, ProgramPlace::kOutRgb);
    m_reader.expect("=");
    if (m_reader.at("lerp")) {
        lerp();
        if (m_reader.take_if("+")) m_final.d = operand(Place::final_rgb).input;
        m_reader.expect_end();
        return;
    }
    const Operand first = operand(Place::final_rgb);
    if (m_reader.take_if("*")) {
        product(first, operand(Place::final_rgb));
        if (m_reader.take_if("+")) m_final.d = operand(Place::final_rgb).input;
    } else if (!m_reader.take_if("+")) {
        m_final.d = first.input;
    } else if (m_reader.at("lerp")) {
        m_final.d = first.input;
        lerp();
    } else {
        sum(first.input, operand(Place::final_rgb).input);
    }
    m_reader.expect_end();
}

void FinalParser::out_alpha() {
    begin(m_has_alpha, ProgramPlace::kOutAlpha);
    m_reader.expect("=");
    m_final.g = take_operand(m_reader, m_dialect, Place::final_alpha).input;
    m_reader.expect_end();
}

void FinalParser::finish() {
    if (m_product_use && !m_has_product)
        m_reader.complain(*m_product_use, "final_product is used but never set");
}

}  // namespace burnish
