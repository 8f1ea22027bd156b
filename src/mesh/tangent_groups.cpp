#include "mesh/tangent_groups.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <cmath>
#include <limits>

#include "core/dmath.hpp"
#include "mesh/fans.hpp"

namespace burnish {
namespace {

bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Unit vector, or zero if `v` has no direction.
glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    const double square = glm::dot(v, v);
    return square > 0.0 && std::isfinite(square) ? v / std::sqrt(square) : glm::dvec3(0.0);
}

/// `v` in the plane perpendicular to the unit (or zero) vector `n`, made unit.
glm::dvec3 project(const glm::dvec3& v, const glm::dvec3& n) {
    return unit_or_zero(v - glm::dot(v, n) * n);
}

/// Level, where the normal is not nearly upright; along x where it is.
glm::dvec3 arbitrary_tangent(const glm::dvec3& n) {
    constexpr glm::dvec3 kX(1.0, 0.0, 0.0), kY(0.0, 1.0, 0.0);
    if (n == glm::dvec3(0.0)) return kX;
    return std::abs(n.y) < 0.9 ? unit_or_zero(glm::cross(kY, n)) : project(kX, n);
}

struct TriangleUvs {
    std::vector<glm::vec3> along_u;  ///< unit direction in which u grows; zero without uv area
    std::vector<UvSide> sides;
};

TriangleUvs triangle_uvs(const WeldedTriangles& mesh) {
    const std::size_t count = mesh.indices.size() / 3;
    TriangleUvs result{std::vector<glm::vec3>(count, glm::vec3(0.0F)),
                       std::vector<UvSide>(count, UvSide::none)};
    for (std::size_t t = 0; t < count; ++t) {
        const std::uint32_t* v = mesh.indices.data() + 3 * t;
        const glm::vec3 &a = mesh.positions[v[0]], &b = mesh.positions[v[1]],
                        &c = mesh.positions[v[2]];
        if (a == b || b == c || c == a || !finite(a) || !finite(b) || !finite(c)) {
            result.sides[t] = UvSide::excluded;
            continue;
        }
        const glm::dvec2 uv(mesh.uvs[v[0]]);
        const glm::dvec2 uv_ab = glm::dvec2(mesh.uvs[v[1]]) - uv;
        const glm::dvec2 uv_ac = glm::dvec2(mesh.uvs[v[2]]) - uv;
        const double area = uv_ab.x * uv_ac.y - uv_ab.y * uv_ac.x;  // twice, signed
        if (!(std::abs(area) > std::numeric_limits<float>::min()) || !std::isfinite(area)) continue;
        const glm::dvec3 ab = glm::dvec3(b) - glm::dvec3(a), ac = glm::dvec3(c) - glm::dvec3(a);
        const glm::dvec3 along = unit_or_zero(uv_ac.y * ab - uv_ab.y * ac);
        if (along == glm::dvec3(0.0)) continue;
        result.along_u[t] = area > 0.0 ? along : -along;
        result.sides[t] = area > 0.0 ? UvSide::preserved : UvSide::mirrored;
    }
    return result;
}

struct SameSide {
    const UvSide* sides;
    static constexpr bool kJoinsMany = true;
    [[nodiscard]] std::uint32_t side(std::uint32_t triangle) const {
        return sides[triangle] == UvSide::preserved ? 1 : 0;
    }
    [[nodiscard]] static bool joins(std::uint32_t, std::uint32_t) { return true; }
};

/// The triangle's share in the tangent at one of its corners.
glm::dvec3 weighted_tangent(const WeldedTriangles& mesh, std::uint32_t corner,
                            const glm::dvec3& along_u, const glm::dvec3& normal) {
    const glm::dvec3 place(mesh.positions[mesh.indices[corner]]);
    const glm::dvec3 to_next(mesh.positions[mesh.indices[next_corner(corner)]]);
    const glm::dvec3 to_previous(mesh.positions[mesh.indices[previous_corner(corner)]]);
    const double cosine =
        glm::dot(project(to_next - place, normal), project(to_previous - place, normal));
    // A corner without angle still decides where it is the only one.
    constexpr double kLeastWeight = 1e-15;
    return std::max(dmath::acos(cosine), kLeastWeight) * project(along_u, normal);
}

/// Collects the groups vertex by vertex.
class Grouping {
  public:
    explicit Grouping(const WeldedTriangles& mesh) : m_mesh(mesh), m_uvs(triangle_uvs(mesh)) {
        spread_sides(mesh.indices, m_uvs.sides);
        m_result.group_of_corner.resize(mesh.indices.size());
    }

    TangentGroups run() {
        const auto uses = [&](std::uint32_t t) { return m_uvs.sides[t] != UvSide::excluded; };
        const std::size_t vertex_count = m_mesh.positions.size();
        const CornerLists lists = corner_lists(m_mesh.indices, vertex_count, uses);
        FanSplitter splitter(m_mesh.indices, SameSide{m_uvs.sides.data()});
        std::vector<std::uint32_t> first_group(vertex_count);
        m_result.vertex_of_group.reserve(vertex_count);
        for (std::uint32_t v = 0; v < vertex_count; ++v) {
            first_group[v] = static_cast<std::uint32_t>(m_result.vertex_of_group.size());
            add_groups(v, lists.at(v), splitter.split(lists.at(v)));
        }
        m_result.tangent_of_group.shrink_to_fit();
        for (std::uint32_t c = 0; c < m_mesh.indices.size(); ++c)
            if (!uses(c / 3)) m_result.group_of_corner[c] = first_group[m_mesh.indices[c]];
        return std::move(m_result);
    }

  private:
    void add_groups(std::uint32_t vertex, std::span<const std::uint32_t> corners,
                    std::span<const std::uint32_t> fan) {
        const glm::dvec3 normal = unit_or_zero(glm::dvec3(m_mesh.normals[vertex]));
        const auto first = static_cast<std::uint32_t>(m_result.vertex_of_group.size());
        m_sums.clear();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const std::uint32_t t = corners[i] / 3;
            if (fan[i] == m_sums.size()) m_sums.push_back({glm::dvec3(0.0), m_uvs.sides[t]});
            m_result.group_of_corner[corners[i]] = first + fan[i];
            const glm::dvec3 along_u(m_uvs.along_u[t]);
            if (along_u != glm::dvec3(0.0))
                m_sums[fan[i]].tangent += weighted_tangent(m_mesh, corners[i], along_u, normal);
        }
        // Only corners of what is no triangle: they too need a group.
        if (m_sums.empty()) m_sums.push_back({glm::dvec3(0.0), UvSide::preserved});
        for (const Sum& sum : m_sums) {
            glm::dvec3 tangent = project(sum.tangent, normal);
            if (tangent == glm::dvec3(0.0)) tangent = arbitrary_tangent(normal);
            m_result.vertex_of_group.push_back(vertex);
            m_result.tangent_of_group.emplace_back(glm::vec3(tangent),
                                                   sum.side == UvSide::preserved ? 1.0F : -1.0F);
        }
    }

    struct Sum {
        glm::dvec3 tangent;
        UvSide side;
    };
    const WeldedTriangles& m_mesh;
    TriangleUvs m_uvs;
    TangentGroups m_result;
    std::vector<Sum> m_sums;
};

}  // namespace

void check_tangent_limit(std::size_t corner_count) {
    constexpr std::size_t kMaxTriangles = std::size_t{1} << 28;
    if (corner_count / 3 > kMaxTriangles)
        throw Error(ErrorCode::limit, fmt::format("{} triangles, expected at most {}",
                                                  corner_count / 3, kMaxTriangles));
}

TangentGroups tangent_groups(const WeldedTriangles& mesh) {
    check_tangent_limit(mesh.indices.size());
    return Grouping(mesh).run();
}

}  // namespace burnish
