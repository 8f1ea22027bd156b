#pragma once

#include <array>
#include <burnish/combiner.hpp>
#include <burnish/machine.hpp>
#include <burnish/multipass.hpp>
#include <span>
#include <vector>

namespace burnish {

/// Codes that a register component may hold, inclusive.
struct CodeRange {
    int low = 0, high = 0;
};

/// Part of a register that one portion writes: r, g and b, or alpha.
struct RegisterPart {
    Register reg;
    bool alpha;

    friend auto operator<=>(const RegisterPart&, const RegisterPart&) = default;
};

/// Ranges of every part of every register.
class RegisterRanges {
  public:
    CodeRange& operator[](RegisterPart p) {
        return m_ranges[static_cast<std::size_t>(p.reg)][p.alpha ? 1 : 0];
    }
    CodeRange operator[](RegisterPart p) const {
        return m_ranges[static_cast<std::size_t>(p.reg)][p.alpha ? 1 : 0];
    }

  private:
    std::array<std::array<CodeRange, 2>, static_cast<std::size_t>(Register::discard) + 1>
        m_ranges{};
};

/// What an input of a portion reads.
RegisterPart part_of(const Input& input);

/// What nine-bit registers may hold before stage 0 (element 0) and after each stage, by interval
/// arithmetic. A square is not negative.
std::vector<RegisterRanges> register_ranges(const CombinerProgram& program, const Machine& machine,
                                            std::span<const UnitTexels> units);

}  // namespace burnish
