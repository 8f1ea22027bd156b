#include <fmt/format.h>

#include <array>
#include <burnish/program_text.hpp>

#include "program/parse_final.hpp"
#include "program/parse_stage.hpp"

namespace burnish {
namespace {

/// The parts of a program in their order.
enum class Part { constants, stages, final_inputs, outputs };

class ProgramParser {
  public:
    ProgramParser(Reader& reader, const Dialect& dialect, CombinerProgram& program,
                  ProgramLines& lines)
        : m_reader(reader),
          m_dialect(dialect),
          m_program(program),
          m_lines(lines),
          m_final(reader, dialect, program.final_combiner, lines) {}

    void parse() {
        while (!m_reader.at_end()) m_reader.statement([this] { statement(); });
        if (m_reader.peek().kind == Token::Kind::open_comment)
            m_reader.complain(m_reader.peek(), "the text ends in a comment, expected '*/'");
        m_final.finish();
        if (!m_fetches.empty()) {
            count_stage(m_fetch);
            add_stage(idle_stage());
        }
        if (m_program.stages.empty()) m_program.stages.push_back(idle_stage());
    }

  private:
    void statement() {
        const Token start = m_reader.peek();
        if (m_reader.at("const0") || m_reader.at("const1")) {
            enter(Part::constants, "in front of the general stages");
            global_constant();
        } else if (m_reader.at("{")) {
            enter(Part::stages, "in front of the final combiner");
            count_stage(start);
            add_stage(parse_stage(m_reader, m_dialect, stage_lines()));
        } else if (m_reader.at("fetch")) {
            enter(Part::stages, "in front of the final combiner");
            fetches();
        } else {
            final_statement();
        }
    }

    void final_statement() {
        constexpr std::array<std::string_view, 6> kWords{
            "const0", "const1", "clamp_color_sum", "final_product", "out", "fetch"};
        const Token& token = m_reader.peek();
        const bool out = token.kind == Token::Kind::word && token.text == "out";
        if (m_reader.at("clamp_color_sum")) {
            enter(Part::final_inputs, "in front of out.rgb and out.a");
            m_final.clamp_color_sum();
        } else if (m_reader.at("final_product")) {
            enter(Part::final_inputs, "in front of out.rgb and out.a");
            m_final.final_product();
        } else if (out && token.component == "rgb") {
            enter(Part::outputs, "");
            m_final.out_rgb();
        } else if (out && token.component == "a") {
            enter(Part::outputs, "");
            m_final.out_alpha();
        } else if (out) {
            m_reader.fail("out.rgb or out.a");
        } else {
            fail_word(m_reader,
                      "const0, const1, '{', clamp_color_sum, final_product, out.rgb or "
                      "out.a",
                      kWords);
        }
    }

    /// Complains about the next token if a later part has begun.
    void enter(Part part, std::string_view expected) {
        if (part < m_part)
            m_reader.complain(m_reader.peek(), fmt::format("{} comes too late, expected it {}",
                                                           quoted(m_reader.peek()), expected));
        else
            m_part = part;
    }

    void global_constant() {
        const bool first = m_reader.at("const0");
        bool& seen = first ? m_has_const0 : m_has_const1;
        (first ? m_program.const0 : m_program.const1) = parse_constant(m_reader, seen);
        seen = true;
    }

    void fetches() {
        m_fetch = m_reader.peek();
        if (!m_dialect.extended)
            m_reader.complain(m_fetch, fmt::format("fetch in {}, it is a word of {}",
                                                   m_dialect.header, kBrn10.header));
        parse_fetches(m_reader, m_dialect, m_fetches, stage_lines());
    }

    /// Of the stage that comes next.
    StageLines stage_lines() { return {m_lines, m_program.stages.size()}; }

    /// Complains at the first stage that is too many.
    void count_stage(const Token& where) {
        if (m_stages++ == m_dialect.stages)
            m_reader.complain(where, fmt::format("general stage number {}, {} has at most {}",
                                                 m_stages, m_dialect.header, m_dialect.stages));
    }

    void add_stage(GeneralStage stage) {
        if (m_stages > m_dialect.stages) return;
        stage.fetches = std::move(m_fetches);
        m_fetches.clear();
        m_program.stages.push_back(std::move(stage));
    }

    Reader& m_reader;
    const Dialect& m_dialect;
    CombinerProgram& m_program;
    ProgramLines& m_lines;
    FinalParser m_final;
    Part m_part = Part::constants;
    bool m_has_const0 = false, m_has_const1 = false;
    int m_stages = 0;
    std::vector<StageFetch> m_fetches;  ///< for the next stage
    Token m_fetch;                      ///< the last one's beginning
};

}  // namespace

Parsed<CombinerProgram> parse_combiners(std::string_view text) {
    constexpr std::array kHeaders{kRc10.header, kBrn10.header};
    Reader reader(text);
    CombinerProgram program;
    ProgramLines lines;
    reader.text([&] {
        const auto header = reader.header(kHeaders);
        if (header)
            ProgramParser(reader, *header == kRc10.header ? kRc10 : kBrn10, program, lines).parse();
    });
    if (reader.failed()) return {std::nullopt, reader.take_errors(), {}};
    return {std::move(program), {}, std::move(lines)};
}

}  // namespace burnish
