#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "raster/setup.hpp"

/// Which pixels a triangle covers, by exact arithmetic on snapped window coordinates. The top-left
/// rule is expressed as a sample that lies an infinitesimal step e to the right of the pixel centre
/// and e^2 below it: no edge ever passes through it.
namespace burnish::exact {

/// Window coordinates, 1/256 pixel, y down.
struct Point {
    std::int64_t x, y;
};
using Triangle = std::array<Point, 3>;

inline Point centre(int px, int py) {
    return {256 * std::int64_t{px} + 128, 256 * std::int64_t{py} + 128};
}

/// On which side of the line from p to q the sample lies: -1, +1, or 0 if p = q.
inline int side(const Point& p, const Point& q, const Point& sample) {
    const std::int64_t dx = q.x - p.x, dy = q.y - p.y;
    const std::int64_t at_centre = dx * (sample.y - p.y) - dy * (sample.x - p.x);
    for (const std::int64_t term : {at_centre, -dy, dx}) {  // orders 1, e, e^2
        if (term != 0) return term > 0 ? 1 : -1;
    }
    return 0;
}

/// 0: not covered; otherwise the sign of the area.
inline int covers(const Triangle& t, int px, int py) {
    const Point sample = centre(px, py);
    const int first = side(t[0], t[1], sample);
    const bool inside = side(t[1], t[2], sample) == first && side(t[2], t[0], sample) == first;
    return inside ? first : 0;
}

inline std::int64_t twice_area(const Triangle& t) {
    return (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
}

/// How often a closed polygon runs around the sample, positive like the area: crossings of the ray
/// to the right.
inline int winding(std::span<const Point> polygon, int px, int py) {
    const Point sample = centre(px, py);
    int turns = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const bool p_above = p.y <= sample.y, q_above = q.y <= sample.y;
        if (p_above == q_above) continue;
        const int s = side(p, q, sample);
        if (p_above && s > 0) ++turns;
        if (q_above && s < 0) --turns;
    }
    return turns;
}

inline Triangle corners(const SetupTriangle& t) {
    return {Point{t.x[0], t.y[0]}, Point{t.x[1], t.y[1]}, Point{t.x[2], t.y[2]}};
}

}  // namespace burnish::exact
