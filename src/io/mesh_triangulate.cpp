#include "io/mesh_triangulate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

namespace burnish {
namespace {

using Corners = std::span<const SoupCorner>;

bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    const double square = glm::dot(v, v);
    return square > 0.0 && std::isfinite(square) ? v / std::sqrt(square) : glm::dvec3(0.0);
}

/// Twice the signed area of a triangle in the plane.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Ear clipping: G. Meisters, "Polygons have ears", 1975. Works on a polygon that runs
/// counter-clockwise; one that crosses itself is cut into as many triangles, somehow, in time that
/// grows with the square of its corners.
class EarClipper {
  public:
    explicit EarClipper(std::span<const glm::dvec2> points) : m_points(points) {}

    /// Corner numbers, three per triangle, points.size() - 2 triangles.
    std::span<const std::uint32_t> clip() {
        const auto count = static_cast<std::uint32_t>(m_points.size());
        // A simple polygon takes half a test per pair of corners, and some for corners in vain.
        m_tests_left = std::size_t{4} * count * count;
        m_ring.resize(count);
        std::iota(m_ring.begin(), m_ring.end(), 0U);
        while (m_ring.size() > 3) {
            const std::size_t ear = find_ear();
            add(ear);
            m_ring.erase(m_ring.begin() + static_cast<std::ptrdiff_t>(ear));
            // Going on behind the cut spreads the cuts instead of fanning from one corner.
            m_start = ear + 1;
        }
        add(1);
        return m_triangles;
    }

  private:
    [[nodiscard]] std::uint32_t at(std::size_t i) const { return m_ring[i % m_ring.size()]; }

    void add(std::size_t i) {
        m_triangles.insert(m_triangles.end(), {at(i + m_ring.size() - 1), at(i), at(i + 1)});
    }

    [[nodiscard]] std::size_t find_ear() {
        for (std::size_t k = 0; k < m_ring.size() && m_tests_left > m_ring.size(); ++k) {
            const std::size_t i = (m_start + k) % m_ring.size();
            if (is_ear(i)) return i;
        }
        return m_start % m_ring.size();
    }

    [[nodiscard]] bool is_ear(std::size_t i) {
        const std::uint32_t before = at(i + m_ring.size() - 1), here = at(i), after = at(i + 1);
        const glm::dvec2 &a = m_points[before], &b = m_points[here], &c = m_points[after];
        if (!(turn(a, b, c) > 0.0)) return false;
        return std::none_of(m_ring.begin(), m_ring.end(), [&](std::uint32_t other) {
            const glm::dvec2& p = m_points[other];
            --m_tests_left;
            if (p == a || p == b || p == c) return false;
            return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
        });
    }

    std::span<const glm::dvec2> m_points;
    std::vector<std::uint32_t> m_ring;
    std::vector<std::uint32_t> m_triangles;
    std::size_t m_start = 1;
    std::size_t m_tests_left = 0;
};

class Triangulator {
  public:
    Triangulator(const MeshSoup& soup, MeshReport& report) : m_soup(soup), m_report(report) {
        m_result.corners.reserve(soup.corners.size());
        m_result.face_normals.reserve(soup.polygon_end.size());
        m_result.polygons.reserve(soup.polygon_end.size());
    }

    SoupTriangles run() {
        std::size_t begin = 0;
        for (std::uint32_t k = 0; k < m_soup.polygon_end.size(); ++k) {
            const std::size_t end = m_soup.polygon_end[k];
            add_polygon(Corners(m_soup.corners).subspan(begin, end - begin), k);
            begin = end;
        }
        return std::move(m_result);
    }

  private:
    [[nodiscard]] glm::dvec3 place(const SoupCorner& corner) const {
        return glm::dvec3(m_soup.positions[corner.position]);
    }
    [[nodiscard]] glm::dvec3 area_vector(const SoupCorner& a, const SoupCorner& b,
                                         const SoupCorner& c) const {
        return glm::cross(place(b) - place(a), place(c) - place(a));
    }

    void add_polygon(Corners corners, std::uint32_t number) {
        const bool is_finite = std::all_of(corners.begin(), corners.end(), [&](const auto& corner) {
            return finite(m_soup.positions[corner.position]);
        });
        if (!is_finite) {
            ++m_report.nonfinite_faces;
            return;
        }
        // Newell's normal: the sum over the fan of area vectors, right for concave polygons too.
        glm::dvec3 sum(0.0), first_area(0.0);
        for (std::size_t i = 2; i < corners.size(); ++i) {
            const glm::dvec3 area = area_vector(corners[0], corners[i - 1], corners[i]);
            sum += area;
            if (first_area == glm::dvec3(0.0)) first_area = area;
        }
        if (first_area == glm::dvec3(0.0)) {
            ++m_report.degenerate_faces;
            return;
        }
        m_result.polygons.push_back(number);
        const glm::dvec3 normal = unit_or_zero(sum == glm::dvec3(0.0) ? first_area : sum);
        constexpr std::size_t kMostCornersToClip = 1024;
        if (corners.size() > 3 && corners.size() <= kMostCornersToClip &&
            !fan_is_right(corners, normal))
            add_ears(corners, normal);
        else
            add_fan(corners, normal);
    }

    /// Whether no triangle of the fan faces away.
    [[nodiscard]] bool fan_is_right(Corners corners, const glm::dvec3& normal) const {
        for (std::size_t i = 2; i < corners.size(); ++i)
            if (glm::dot(area_vector(corners[0], corners[i - 1], corners[i]), normal) < 0.0)
                return false;
        return true;
    }

    void add_fan(Corners corners, const glm::dvec3& normal) {
        for (std::size_t i = 2; i < corners.size(); ++i)
            add_triangle(corners[0], corners[i - 1], corners[i], normal);
    }

    void add_ears(Corners corners, const glm::dvec3& normal) {
        const glm::dvec3 size = glm::abs(normal);
        // Drops the axis nearest to the normal and keeps the turning direction.
        const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        const int first = (axis + 1) % 3, second = (axis + 2) % 3;
        m_points.clear();
        for (const SoupCorner& corner : corners) {
            const glm::dvec3 p = place(corner);
            m_points.emplace_back(normal[axis] > 0.0 ? p[first] : -p[first], p[second]);
        }
        EarClipper clipper(m_points);
        const std::span<const std::uint32_t> ears = clipper.clip();
        for (std::size_t i = 0; i < ears.size(); i += 3)
            add_triangle(corners[ears[i]], corners[ears[i + 1]], corners[ears[i + 2]], normal);
    }

    void add_triangle(const SoupCorner& a, const SoupCorner& b, const SoupCorner& c,
                      const glm::dvec3& normal) {
        m_result.corners.insert(m_result.corners.end(), {a, b, c});
        m_result.face_normals.emplace_back(normal);
    }

    const MeshSoup& m_soup;
    MeshReport& m_report;
    SoupTriangles m_result;
    std::vector<glm::dvec2> m_points;
};

}  // namespace

SoupTriangles triangulate(const MeshSoup& soup, MeshReport& report) {
    return Triangulator(soup, report).run();
}

}  // namespace burnish
