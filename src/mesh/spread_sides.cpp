#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "mesh/tangent_groups.hpp"

namespace burnish {
namespace {

/// Triangles by edge, so that one step from triangle to triangle takes time in proportion to the
/// triangles met, also where thousands share an edge.
class EdgeTable {
  public:
    EdgeTable(std::span<const std::uint32_t> indices, std::span<const UvSide> sides) {
        for (std::uint32_t c = 0; c < indices.size(); ++c) {
            if (sides[c / 3] == UvSide::excluded) continue;
            const std::uint32_t from = indices[c];
            const std::uint32_t to = indices[c % 3 == 2 ? c - 2 : c + 1];
            m_ends.push_back({std::min(from, to), std::max(from, to), c});
        }
        std::sort(m_ends.begin(), m_ends.end(), [](const End& a, const End& b) {
            return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
        });
        m_edge_of_corner.resize(indices.size());
        for (std::size_t i = 0; i < m_ends.size(); ++i) {
            if (i == 0 || m_ends[i].low != m_ends[i - 1].low ||
                m_ends[i].high != m_ends[i - 1].high)
                m_begin.push_back(static_cast<std::uint32_t>(i));
            m_edge_of_corner[m_ends[i].corner] = static_cast<std::uint32_t>(m_begin.size() - 1);
        }
        m_begin.push_back(static_cast<std::uint32_t>(m_ends.size()));
    }

    [[nodiscard]] std::size_t size() const { return m_begin.size() - 1; }
    [[nodiscard]] std::uint32_t edge(std::uint32_t corner) const {
        return m_edge_of_corner[corner];
    }
    template <class Visit>
    void for_each_triangle(std::uint32_t edge, const Visit& visit) const {
        for (std::uint32_t i = m_begin[edge]; i < m_begin[edge + 1]; ++i)
            visit(m_ends[i].corner / 3);
    }

  private:
    struct End {
        std::uint32_t low, high, corner;
    };
    std::vector<End> m_ends;
    std::vector<std::uint32_t> m_begin;
    std::vector<std::uint32_t> m_edge_of_corner;
};

/// What a step has brought to an edge or a triangle.
enum class Mark : std::uint8_t { untouched, mirrored, preserved, done };

void put(Mark& mark, UvSide side) {
    if (side == UvSide::preserved)
        mark = Mark::preserved;
    else if (mark == Mark::untouched)
        mark = Mark::mirrored;
}

}  // namespace

void spread_sides(std::span<const std::uint32_t> indices, std::span<UvSide> sides) {
    const auto lacks_side = [](UvSide side) { return side == UvSide::none; };
    if (std::none_of(sides.begin(), sides.end(), lacks_side)) return;
    const EdgeTable table(indices, sides);
    std::vector<Mark> edge_mark(table.size(), Mark::untouched);
    std::vector<Mark> triangle_mark(sides.size(), Mark::untouched);
    std::vector<std::uint32_t> front, edges, reached;
    for (std::uint32_t t = 0; t < sides.size(); ++t)
        if (sides[t] == UvSide::mirrored || sides[t] == UvSide::preserved) front.push_back(t);
    while (!front.empty()) {
        edges.clear();
        for (const std::uint32_t t : front) {
            for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c) {
                Mark& mark = edge_mark[table.edge(c)];
                if (mark == Mark::done) continue;
                if (mark == Mark::untouched) edges.push_back(table.edge(c));
                put(mark, sides[t]);
            }
        }
        reached.clear();
        for (const std::uint32_t edge : edges) {
            const UvSide side =
                edge_mark[edge] == Mark::preserved ? UvSide::preserved : UvSide::mirrored;
            edge_mark[edge] = Mark::done;
            table.for_each_triangle(edge, [&](std::uint32_t t) {
                if (!lacks_side(sides[t])) return;
                if (triangle_mark[t] == Mark::untouched) reached.push_back(t);
                put(triangle_mark[t], side);
            });
        }
        for (const std::uint32_t t : reached)
            sides[t] = triangle_mark[t] == Mark::preserved ? UvSide::preserved : UvSide::mirrored;
        front.swap(reached);
    }
    std::replace(sides.begin(), sides.end(), UvSide::none, UvSide::preserved);
}

}  // namespace burnish
