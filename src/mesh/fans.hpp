#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace burnish {

/// Corner c belongs to triangle c / 3; these are the corners after and before it in that triangle.
inline std::uint32_t next_corner(std::uint32_t c) {
    return c % 3 == 2 ? c - 2 : c + 1;
}
inline std::uint32_t previous_corner(std::uint32_t c) {
    return c % 3 == 0 ? c + 2 : c - 1;
}

/// The corners at each vertex: those at v are list[begin[v]] up to list[begin[v + 1]], ascending.
struct CornerLists {
    std::vector<std::uint32_t> begin;
    std::vector<std::uint32_t> list;

    [[nodiscard]] std::span<const std::uint32_t> at(std::size_t vertex) const {
        return {list.data() + begin[vertex], list.data() + begin[vertex + 1]};
    }
};

/// @param indices  vertex of each corner, fewer than 2^32 of them
/// @param uses     uses(triangle) says whether the triangle's corners are listed
template <class Uses>
CornerLists corner_lists(std::span<const std::uint32_t> indices, std::size_t vertex_count,
                         const Uses& uses) {
    CornerLists lists;
    lists.begin.assign(vertex_count + 1, 0);
    const auto corner_count = static_cast<std::uint32_t>(indices.size());
    for (std::uint32_t c = 0; c < corner_count; ++c)
        if (uses(c / 3)) ++lists.begin[indices[c]];
    std::uint32_t sum = 0;
    for (std::uint32_t& begin : lists.begin) {
        sum += begin;
        begin = sum;
    }
    lists.list.resize(sum);
    for (std::uint32_t c = corner_count; c-- > 0;)
        if (uses(c / 3)) lists.list[--lists.begin[indices[c]]] = c;
    return lists;
}

/// Divides the corners around a vertex into fans: corners whose triangles are connected through
/// edges at that vertex. An edge connects the triangles on its two sides (they run along it in
/// opposite directions) if `rule` lets it.
///
/// Rule::side(triangle)   0 or 1; an edge never connects different sides
/// Rule::joins(a, b)      whether the edge between triangles a and b connects them
/// Rule::kJoinsMany       whether an edge with more than two triangles connects all of them or none
template <class Rule>
class FanSplitter {
  public:
    FanSplitter(std::span<const std::uint32_t> indices, Rule rule)
        : m_indices(indices), m_rule(rule) {}

    /// Fan of each of `corners` (fewer than 2^30, all at one vertex, in triangles with three
    /// distinct vertices): numbered from 0 by first appearance. Valid until the next call.
    std::span<const std::uint32_t> split(std::span<const std::uint32_t> corners) {
        const auto count = static_cast<std::uint32_t>(corners.size());
        m_parent.resize(count);
        m_ends.clear();
        for (std::uint32_t i = 0; i < count; ++i) {
            m_parent[i] = i;
            const std::uint32_t c = corners[i];
            const std::uint32_t side = m_rule.side(c / 3);
            m_ends.push_back(edge_end(m_indices[next_corner(c)], side, i, 0));
            m_ends.push_back(edge_end(m_indices[previous_corner(c)], side, i, 1));
        }
        std::sort(m_ends.begin(), m_ends.end());
        for (std::size_t first = 0; first < m_ends.size();) {
            std::size_t last = first + 1;
            while (last < m_ends.size() && m_ends[last] >> 31 == m_ends[first] >> 31) ++last;
            join(corners, std::span(m_ends).subspan(first, last - first));
            first = last;
        }
        std::uint32_t fans = 0;
        m_fan.resize(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t root = find(i);  // the lowest of its fan, so already numbered
            m_fan[i] = root == i ? fans++ : m_fan[root];
        }
        return m_fan;
    }

  private:
    /// Sorts by neighbouring vertex, then side, then position in the list of corners.
    static std::uint64_t edge_end(std::uint32_t neighbour, std::uint32_t side, std::uint32_t i,
                                  std::uint32_t incoming) {
        return std::uint64_t{neighbour} << 32 | std::uint64_t{side} << 31 | i << 1 | incoming;
    }
    static std::uint32_t corner_of(std::uint64_t end) {
        return static_cast<std::uint32_t>(end & 0x7fffffffU) >> 1;
    }

    /// `ends`: all corners on one edge and side.
    void join(std::span<const std::uint32_t> corners, std::span<const std::uint64_t> ends) {
        const auto incoming = std::count_if(ends.begin(), ends.end(),
                                            [](std::uint64_t end) { return (end & 1) != 0; });
        if (incoming == 0 || incoming == static_cast<std::ptrdiff_t>(ends.size())) return;
        if (ends.size() > 2 && !Rule::kJoinsMany) return;
        const std::uint32_t a = corner_of(ends[0]);
        for (const std::uint64_t end : ends.subspan(1)) {
            const std::uint32_t b = corner_of(end);
            if (m_rule.joins(corners[a] / 3, corners[b] / 3)) unite(a, b);
        }
    }

    std::uint32_t find(std::uint32_t i) {
        while (m_parent[i] != i) {
            m_parent[i] = m_parent[m_parent[i]];
            i = m_parent[i];
        }
        return i;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (a < b)
            m_parent[b] = a;
        else
            m_parent[a] = b;
    }

    std::span<const std::uint32_t> m_indices;
    Rule m_rule;
    std::vector<std::uint32_t> m_parent;
    std::vector<std::uint64_t> m_ends;
    std::vector<std::uint32_t> m_fan;
};

}  // namespace burnish
