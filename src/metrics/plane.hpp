#pragma once

#include <cstddef>
#include <vector>

namespace burnish::metrics {

/// A number for every pixel, row 0 on top: the map of an error.
struct Plane {
    int width = 0;
    int height = 0;
    std::vector<double> values;  ///< rows one after the other; empty if nobody asked for them

    Plane() = default;
    Plane(int w, int h)
        : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

    [[nodiscard]] double* row(int y) { return values.data() + offset(y); }
    [[nodiscard]] const double* row(int y) const { return values.data() + offset(y); }

  private:
    [[nodiscard]] std::size_t offset(int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    }
};

}  // namespace burnish::metrics
