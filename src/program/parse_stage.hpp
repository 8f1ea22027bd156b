#pragma once

#include <burnish/combiner.hpp>
#include <burnish/program_place.hpp>
#include <vector>

#include "program/dialect.hpp"
#include "program/reader.hpp"

namespace burnish {

/// The next token is const0 or const1: takes `const0 = (n, n, n, n);`. Complains, at the name, if
/// `taken`; returns the numbers, each in [0, 1] unless there was an error.
glm::vec4 parse_constant(Reader& reader, bool taken);

/// Notes where the parts of one general stage begin; of two of a kind the first counts.
class StageLines {
  public:
    StageLines(ProgramLines& lines, std::size_t stage) : m_lines(lines), m_stage(stage) {}
    void note(ProgramPlace::Part part, int statement, const Token& begin) {
        m_lines.emplace(ProgramPlace{part, m_stage, static_cast<std::uint8_t>(statement)},
                        begin.line);
    }

  private:
    ProgramLines& m_lines;
    std::size_t m_stage;
};

/// The next token is '{': takes a general stage up to its '}'.
GeneralStage parse_stage(Reader& reader, const Dialect& dialect, StageLines lines);

/// The next token is `fetch`: takes the block and adds its fetches to `fetches`.
void parse_fetches(Reader& reader, const Dialect& dialect, std::vector<StageFetch>& fetches,
                   StageLines lines);

}  // namespace burnish
