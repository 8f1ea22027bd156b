#pragma once

#include <burnish/combiner.hpp>
#include <burnish/program_place.hpp>
#include <optional>

#include "program/dialect.hpp"
#include "program/operand.hpp"
#include "program/reader.hpp"

namespace burnish {

/// The statements of the final combiner, one call per statement.
class FinalParser {
  public:
    /// Notes in `lines` where statements begin.
    FinalParser(Reader& reader, const Dialect& dialect, FinalCombiner& target, ProgramLines& lines)
        : m_reader(reader), m_dialect(dialect), m_final(target), m_lines(lines) {}

    /// The next token is clamp_color_sum.
    void clamp_color_sum();
    /// The next token is final_product.
    void final_product();
    /// The next token is out.rgb.
    void out_rgb();
    /// The next token is out.a.
    void out_alpha();
    /// Behind the last statement.
    void finish();

  private:
    Token begin(bool& seen);
    Token begin(bool& seen, std::uint8_t statement);
    Operand operand(Place place);
    void product_factor(Input& target);
    void lerp();
    void product(const Operand& x, const Operand& y);
    void sum(const Input& x, const Input& y);

    Reader& m_reader;
    const Dialect& m_dialect;
    FinalCombiner& m_final;
    ProgramLines& m_lines;
    bool m_clamps = false, m_has_product = false, m_has_rgb = false, m_has_alpha = false;
    std::optional<Token> m_product_use;  ///< the first
};

}  // namespace burnish
