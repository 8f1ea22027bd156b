#pragma once

#include <burnish/machine.hpp>
#include <vector>

#include "models/cover.hpp"

namespace burnish {

/// Where a table has to have texels.
struct TableDomain {
    /// Of each argument. An argument that is never negative may stop where the function has come to
    /// rest, at the least bound beyond which it stays what it is at the far end, whatever the other
    /// argument is; one that may be negative begins at 0 if the function is the same below.
    std::vector<Interval> arguments;
    double height = 0.0;  ///< largest value of the function
    double error = 0.0;   ///< of interpolation in the finest table, over the height
    /// Of each argument: the largest change of the function by one of the argument.
    std::vector<double> slopes;
};

/// By looking at the function in many places.
TableDomain table_domain(const Expr& function, const std::vector<const Expr*>& args, Ranges& ranges,
                         NumberModel numbers);

/// Texels of the finest table: of one argument and of two, where no side has more than the first.
inline constexpr int kFinest1d = 4096, kFinest2d = 1 << 18;

/// Whether texels along an argument are better spread over its logarithm.
bool is_logarithmic(const Expr& arg, const Interval& range);

}  // namespace burnish
