#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "models/generators/field.hpp"

namespace burnish::generators {

/// Grooves of many strokes, on a texture that repeats in both directions. Where strokes cross, the
/// deepest shows: a texel has its direction, its wall and its number.
class Strokes {
  public:
    explicit Strokes(int size);

    struct Stroke {
        std::uint32_t number;  ///< from 1 on
        double half_width;     ///< texels
        double depth;          ///< texels
    };
    /// Presses one dent into the surface, `at` columns and rows; strokes are chains of them, half a
    /// half-width apart. `direction` is the way the stroke goes there: unit, y towards smaller
    /// rows.
    void dent(const Stroke& stroke, const glm::dvec2& at, const glm::dvec2& direction);

    /// Of the groove's wall, which tilts across the stroke alone.
    [[nodiscard]] glm::dvec3 normal(int x, int y) const;
    /// (1, 0) where no stroke went.
    [[nodiscard]] glm::dvec2 direction(int x, int y) const {
        return m_marks[index(x, y)].direction;
    }
    /// 0 where no stroke went.
    [[nodiscard]] std::uint32_t number(int x, int y) const { return m_marks[index(x, y)].number; }

  private:
    struct Mark {
        glm::dvec2 direction{1.0, 0.0};
        double slope = 0.0;  ///< of the height towards the left of the direction
        std::uint32_t number = 0;
    };
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(m_height.size()) +
               static_cast<std::size_t>(x);
    }

    Field m_height;
    std::vector<Mark> m_marks;
};

}  // namespace burnish::generators
