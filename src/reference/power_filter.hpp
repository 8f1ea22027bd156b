#pragma once

#include <burnish/machine.hpp>

namespace burnish::reference {

/// Mean of max(0, s)^m over s = low .. high, exactly: (F(high) - F(low)) / (high - low) with
/// F(s) = max(0, s)^(m + 1) / (m + 1), which is what a summed table would hold. m >= 0; at
/// low = high the power itself.
[[nodiscard]] double mean_power(double low, double high, double m);

/// Texels of the table that mip_power looks up.
inline constexpr int kPowerTexels = 256;

/// max(0, s)^m from a table of kPowerTexels values, 0 and 1 at the centres of its ends, with mip
/// levels that are means of two: linear within levels and between them, at the level of detail
/// log2(kPowerTexels * step), kept between the first and the last.
[[nodiscard]] double mip_power(double s, double step, double m);

/// A power of a coordinate that changes by `step` from one sample to the next.
struct PowerFilter {
    TableFilter kind = TableFilter::point;
    double step = 0.0;

    [[nodiscard]] double operator()(double s, double m) const;
};

}  // namespace burnish::reference
