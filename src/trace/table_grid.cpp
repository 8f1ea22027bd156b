#include "trace/table_grid.hpp"

#include <algorithm>

#include "core/dmath.hpp"

namespace burnish {

SpacedAxis::SpacedAxis(TableSpacing spacing, double first, double last)
    : m_spacing(first == 0.0 && last > 0.0 ? spacing : TableSpacing::lobe),
      m_last(last),
      m_end(std::max(last, 1.0)) {}

double SpacedAxis::coordinate(double position) const {
    const double x = position * m_last / m_end;
    if (m_spacing == TableSpacing::lobe) return position;
    if (m_spacing == TableSpacing::unit) return x;
    return x > 0.0 ? std::max(1.0 + dmath::log2(x) / TableGrid::kOctaves, 0.0) : 0.0;
}

double SpacedAxis::position(double coordinate) const {
    if (m_spacing == TableSpacing::lobe) return coordinate;
    double x = coordinate;
    if (m_spacing == TableSpacing::logarithm)
        x = coordinate > 0.0 ? dmath::exp2(TableGrid::kOctaves * (coordinate - 1.0)) : 0.0;
    return std::min(x * m_end / m_last, 1.0);
}

}  // namespace burnish
