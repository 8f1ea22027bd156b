#pragma once

#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace burnish::generators {

/// Numbers per texel, rows packed, repeating in both directions.
class Field {
  public:
    explicit Field(int size)
        : m_size(size), m_values(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {}
    [[nodiscard]] double& at(int x, int y) { return m_values[index(x, y)]; }
    [[nodiscard]] double at(int x, int y) const { return m_values[index(x, y)]; }
    [[nodiscard]] int size() const { return m_size; }

  private:
    [[nodiscard]] int wrapped(int i) const { return ((i % m_size) + m_size) % m_size; }
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(wrapped(y)) * static_cast<std::size_t>(m_size) +
               static_cast<std::size_t>(wrapped(x));
    }

    int m_size;
    std::vector<double> m_values;
};

[[nodiscard]] inline glm::dvec3 unit(const glm::dvec3& v) {
    return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

[[nodiscard]] inline glm::dvec2 unit(const glm::dvec2& v) {
    return v / std::sqrt(v.x * v.x + v.y * v.y);
}

/// Unit normal of a height field in texels; y points to smaller rows.
[[nodiscard]] inline glm::dvec3 normal_at(const Field& height, int x, int y) {
    const double dx = 0.5 * (height.at(x + 1, y) - height.at(x - 1, y));
    const double drow = 0.5 * (height.at(x, y + 1) - height.at(x, y - 1));
    return unit(glm::dvec3(-dx, drow, 1.0));
}

}  // namespace burnish::generators
