#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/quantiser.hpp"

namespace burnish {

/// Where the 2^b texels lie along an axis of a model's table that begins at 0, argument x.
enum class TableSpacing {
    lobe,       ///< evenly as far as the function changes: as the program has them
    unit,       ///< evenly over 0 .. 1, or to the end of the axis if that lies beyond: of s and of
                ///< x = 1 - s alike
    logarithm,  ///< evenly over log2 x from 2^-kOctaves to the same end; the first one is x = 0
};

/// The grid that InputRounding::table makes of a model's tables, in more detail.
struct TableGrid {
    static constexpr int kOctaves = 16;

    TableSpacing spacing = TableSpacing::lobe;
    bool linear = false;      ///< between texels, else the nearest
    int index = kExactBits;   ///< of the coordinate, before it looks for texels
    int values = kExactBits;  ///< of texels and results; exact: as many as InputRounding::table

    /// The argument at the ends of the axes of a table.
    struct Table {
        const std::uint8_t* texels = nullptr;
        std::array<double, 2> first{}, last{};
    };
    std::vector<Table> tables = {};
};

/// An axis from `first` to `last` as texels of a TableSpacing see it. Positions 0 .. 1 are those
/// along the axis as the program has it, coordinates 0 .. 1 are even steps of texels.
class SpacedAxis {
  public:
    SpacedAxis(TableSpacing spacing, double first, double last);
    [[nodiscard]] double coordinate(double position) const;
    [[nodiscard]] double position(double coordinate) const;

  private:
    TableSpacing m_spacing;
    double m_last, m_end;
};

}  // namespace burnish
