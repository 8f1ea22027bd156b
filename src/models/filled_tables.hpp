#pragma once

#include <burnish/machine.hpp>
#include <cstddef>
#include <map>
#include <vector>

#include "models/plan.hpp"

namespace burnish {

/// Texels of tables, and how many. Of each function the last table is kept, up to kMostKept texels
/// together: another light leaves most as they are.
class FilledTables {
  public:
    static constexpr std::size_t kMostKept = std::size_t{1} << 22;

    /// Texels of a table of `function` over `args` whose axes lie already: as many as it takes
    /// until interpolation is as good as the numbers are, or as there can be, where they do most.
    /// @param domain  of each argument; texels beyond it repeat its ends
    /// Throws Error{bad_program} where the function has no bound.
    void fill(PlanTable& table, const Expr& function, const std::vector<const Expr*>& args,
              const std::vector<Interval>& domain, NumberModel numbers);

  private:
    struct Entry {
        std::vector<const Expr*> args;
        std::vector<Interval> domain;
        NumberModel numbers;
        PlanTable table;
    };
    std::map<const Expr*, Entry, ByAge> m_last;
    std::size_t m_kept = 0;
};

}  // namespace burnish
