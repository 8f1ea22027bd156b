#include "models/generators/strokes.hpp"

namespace burnish::generators {

Strokes::Strokes(int size)
    : m_height(size), m_marks(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {}

void Strokes::dent(const Stroke& stroke, const glm::dvec2& at, const glm::dvec2& direction) {
    const int size = m_height.size();
    const auto wrapped = [size](int i) { return ((i % size) + size) % size; };
    const double w = stroke.half_width;
    const int left = static_cast<int>(std::floor(at.x - w)), right = static_cast<int>(at.x + w);
    const int top = static_cast<int>(std::floor(at.y - w)), bottom = static_cast<int>(at.y + w);
    for (int y = top; y <= bottom; ++y) {
        for (int x = left; x <= right; ++x) {
            const double dx = x + 0.5 - at.x;
            const double dy = y + 0.5 - at.y;
            const double rest = 1.0 - (dx * dx + dy * dy) / (w * w);
            if (rest <= 0.0) continue;
            const double floor = -stroke.depth * rest * rest;
            const int column = wrapped(x), row = wrapped(y);
            if (floor >= m_height.at(column, row)) continue;
            m_height.at(column, row) = floor;
            const double d = (-direction.y * dx - direction.x * dy) / w;
            const double slope = 4.0 * stroke.depth / w * d * (1.0 - d * d);
            m_marks[index(column, row)] = {direction, slope, stroke.number};
        }
    }
}

glm::dvec3 Strokes::normal(int x, int y) const {
    const Mark& mark = m_marks[index(x, y)];
    return unit(glm::dvec3(mark.direction.y * mark.slope, -mark.direction.x * mark.slope, 1.0));
}

}  // namespace burnish::generators
