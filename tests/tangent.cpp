#include "mesh/tangent.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/shapes.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace burnish {
namespace {

struct Corner {
    glm::vec3 position;
    glm::vec3 normal;
    glm::vec2 uv;
};
using Corners = std::vector<Corner>;

std::vector<glm::vec4> tangents_of(const Corners& corners) {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uvs;
    for (const Corner& corner : corners) {
        positions.push_back(corner.position);
        normals.push_back(corner.normal);
        uvs.push_back(corner.uv);
    }
    return corner_tangents(positions, normals, uvs);
}

Corners corners_of(const MeshData& mesh) {
    Corners corners;
    for (const std::uint32_t i : mesh.indices)
        corners.push_back({mesh.positions[i], mesh.normals[i], mesh.uvs[i]});
    return corners;
}

constexpr glm::vec3 kUp(0.0F, 0.0F, 1.0F);

/// Two triangles of the square (0, 0) to (1, 1) in the plane z = 0, seen from +z.
Corners square(const glm::mat2& uv_from_xy) {
    Corners corners;
    for (const glm::vec2 p : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 0),
                              glm::vec2(1, 1), glm::vec2(0, 1)})
        corners.push_back({glm::vec3(p, 0.0F), kUp, uv_from_xy * p});
    return corners;
}

void expect_near(const glm::vec4& got, const glm::vec4& want, float tolerance = 1e-6F) {
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(got[i], want[i], tolerance) << "component " << i << " of (" << got.x << ", "
                                                << got.y << ", " << got.z << ", " << got.w << ")";
}

void expect_frames(const Corners& corners, const std::vector<glm::vec4>& tangents) {
    ASSERT_EQ(tangents.size(), corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 t(tangents[i]);
        ASSERT_NEAR(glm::dot(t, t), 1.0, 1e-6) << "corner " << i;
        ASSERT_NEAR(glm::dot(t, glm::dvec3(corners[i].normal)), 0.0, 1e-6) << "corner " << i;
        ASSERT_EQ(std::abs(tangents[i].w), 1.0F) << "corner " << i;
    }
}

/// A bumpy patch: no two triangles alike, uv bent and in part mirrored.
Corners bumpy_patch(int size) {
    MeshData mesh = shapes::plane(size, size);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const float x = mesh.positions[i].x, y = mesh.positions[i].y;
        mesh.positions[i].z = 0.3F * x * y - 0.2F * x * x + 0.11F * y;
        mesh.normals[i] = glm::normalize(glm::vec3(-0.3F * y + 0.4F * x, -0.3F * x - 0.11F, 1.0F));
        mesh.uvs[i] = {x < 0.0F ? -x - 0.1F * y : x + 0.2F * y * y, y + 0.3F * x};
    }
    return corners_of(mesh);
}

TEST(Tangent, FollowsUOnAQuad) {
    for (const glm::vec4& t : tangents_of(square(glm::mat2(1.0F))))
        expect_near(t, {1.0F, 0.0F, 0.0F, 1.0F});
}

TEST(Tangent, TurnsWithTheUvs) {
    // u along y, v along -x: a quarter turn, not mirrored.
    for (const glm::vec4& t : tangents_of(square(glm::mat2(0.0F, -1.0F, 1.0F, 0.0F))))
        expect_near(t, {0.0F, 1.0F, 0.0F, 1.0F});
    // u = (x + y) / 2, v = (y - x) / 2: an eighth of a turn.
    const float half = std::sqrt(0.5F);
    for (const glm::vec4& t : tangents_of(square(glm::mat2(0.5F, -0.5F, 0.5F, 0.5F))))
        expect_near(t, {half, half, 0.0F, 1.0F});
}

TEST(Tangent, IsAtConstantVWhenUvsAreSheared) {
    // u = x + y, v = y: u grows along x while v stays.
    for (const glm::vec4& t : tangents_of(square(glm::mat2(1.0F, 0.0F, 1.0F, 1.0F))))
        expect_near(t, {1.0F, 0.0F, 0.0F, 1.0F});
}

TEST(Tangent, SignTellsMirroredUvs) {
    for (const glm::vec4& t : tangents_of(square(glm::mat2(-1.0F, 0.0F, 0.0F, 1.0F))))
        expect_near(t, {-1.0F, 0.0F, 0.0F, -1.0F});
    for (const glm::vec4& t : tangents_of(square(glm::mat2(1.0F, 0.0F, 0.0F, -1.0F))))
        expect_near(t, {1.0F, 0.0F, 0.0F, -1.0F});
}

TEST(Tangent, DoesNotDependOnTheScaleOfUvs) {
    const Corners patch = bumpy_patch(6);
    const std::vector<glm::vec4> want = tangents_of(patch);
    for (const float scale : {1e-3F, 0.25F, 4096.0F}) {
        Corners scaled = patch;
        for (Corner& corner : scaled) corner.uv *= scale;
        const std::vector<glm::vec4> got = tangents_of(scaled);
        for (std::size_t i = 0; i < got.size(); ++i) expect_near(got[i], want[i], 1e-4F);
    }
}

/// Three triangles around one vertex in the plane, with angles of 90, 45 and 45 degrees there, each
/// with its own direction of u.
TEST(Tangent, WeightsByTheAngleOfTheCorner) {
    const glm::vec3 o(0.0F);
    const glm::vec3 a(1.0F, 0.0F, 0.0F), b(0.0F, 1.0F, 0.0F), c(-3.0F, 3.0F, 0.0F);
    // u and v of the corners chosen so that the triangles share uvs along their edges, and u runs
    // along (1, 0) in the first, by the solution of the 2x2 system in the second.
    const glm::vec2 uo(0.0F, 0.0F), ua(1.0F, 0.0F), ub(0.0F, 1.0F), uc(-1.0F, 1.0F);
    const Corners corners = {{o, kUp, uo}, {a, kUp, ua}, {b, kUp, ub},
                             {o, kUp, uo}, {b, kUp, ub}, {c, kUp, uc}};
    // Second triangle: P(u, v) with P(0, 1) = (0, 1), P(-1, 1) = (-3, 3), so dP/du = (3, -2).
    const double pi = std::acos(-1.0);
    const glm::dvec2 first(1.0, 0.0), second = glm::normalize(glm::dvec2(3.0, -2.0));
    const glm::dvec2 sum = glm::normalize(pi / 2 * first + pi / 4 * second);
    const std::vector<glm::vec4> got = tangents_of(corners);
    expect_near(got[0], {sum.x, sum.y, 0.0F, 1.0F});
    EXPECT_EQ(got[3], got[0]);
    // Areas differ by a factor of three: an area-weighted sum would be elsewhere.
    const glm::dvec2 by_area = glm::normalize(0.5 * first + 1.5 * second);
    EXPECT_GT(glm::length(by_area - sum), 0.1);
    // Where a triangle is alone, its own tangent.
    expect_near(got[1], {1.0F, 0.0F, 0.0F, 1.0F});
    expect_near(got[5], {second.x, second.y, 0.0F, 1.0F});
}

TEST(Tangent, IsProjectedIntoThePlaneOfTheNormal) {
    Corners corners = square(glm::mat2(1.0F));
    const glm::vec3 tilted = glm::normalize(glm::vec3(1.0F, 0.0F, 1.0F));
    for (Corner& corner : corners) corner.normal = tilted;
    const float half = std::sqrt(0.5F);
    for (const glm::vec4& t : tangents_of(corners)) expect_near(t, {half, 0.0F, -half, 1.0F});
}

/// A steep triangle counts by its angle in the plane of the normal, not by how much of its tangent
/// lies in that plane.
TEST(Tangent, ProjectsBeforeItSums) {
    const Corner o{{0.0F, 0.0F, 0.0F}, kUp, {0.0F, 0.0F}}, c{{1.0F, 1.0F, 0.0F}, kUp, {1.0F, 1.0F}};
    const Corners corners = {o, {{1.0F, 0.0F, 0.0F}, kUp, {1.0F, 0.0F}},  c, o,
                             c, {{-1.0F, 1.0F, 3.0F}, kUp, {-1.0F, 0.0F}}};
    // First: u along x, 45 degrees. Second: dP/du = (1, -1, -3), seen from above a right angle.
    const double pi = std::acos(-1.0);
    const glm::dvec2 sum = glm::normalize(pi / 4 * glm::dvec2(1.0, 0.0) +
                                          pi / 2 * glm::normalize(glm::dvec2(1.0, -1.0)));
    expect_near(tangents_of(corners)[0], {sum.x, sum.y, 0.0F, 1.0F});
    expect_near(tangents_of(corners)[3], {sum.x, sum.y, 0.0F, 1.0F});
}

/// Two triangles that run along their common edge in the same direction are not its two sides.
TEST(Tangent, IsNotSharedWhereWindingChanges) {
    const Corner o{{0.0F, 0.0F, 0.0F}, kUp, {0.0F, 0.0F}}, a{{1.0F, 0.0F, 0.0F}, kUp, {1.0F, 1.0F}};
    const Corners corners = {o, a, {{0.0F, 1.0F, 0.0F}, kUp, {0.0F, 1.0F}},
                             o, a, {{0.0F, -1.0F, 0.0F}, kUp, {0.0F, 1.0F}}};
    const float half = std::sqrt(0.5F);
    const std::vector<glm::vec4> got = tangents_of(corners);
    for (std::size_t i = 0; i < 3; ++i) expect_near(got[i], {half, -half, 0.0F, 1.0F});
    for (std::size_t i = 3; i < 6; ++i) expect_near(got[i], {half, half, 0.0F, 1.0F});
}

/// Two squares side by side, the second with uv mirrored about their common edge: the corners there
/// agree in position, normal and uv, and must not be averaged.
TEST(Tangent, SplitsWhereUvsAreMirrored) {
    Corners corners = square(glm::mat2(1.0F));
    for (const Corner& corner : square(glm::mat2(1.0F))) {
        Corner mirrored = corner;
        mirrored.position.x += 1.0F;
        mirrored.uv.x = 1.0F - corner.uv.x;
        corners.push_back(mirrored);
    }
    const std::vector<glm::vec4> got = tangents_of(corners);
    for (std::size_t i = 0; i < 6; ++i) expect_near(got[i], {1.0F, 0.0F, 0.0F, 1.0F});
    for (std::size_t i = 6; i < 12; ++i) expect_near(got[i], {-1.0F, 0.0F, 0.0F, -1.0F});
}

TEST(Tangent, IsSharedAcrossAnEdgeButNotAcrossAPoint) {
    // Two pairs of triangles that meet in the origin only, u along x in one and along y in the
    // other.
    Corners corners = square(glm::mat2(1.0F));
    for (const Corner& corner : square(glm::mat2(0.0F, -1.0F, 1.0F, 0.0F)))
        corners.push_back({-corner.position, corner.normal, -corner.uv});
    const std::vector<glm::vec4> got = tangents_of(corners);
    expect_near(got[0], {1.0F, 0.0F, 0.0F, 1.0F});
    expect_near(got[6], {0.0F, 1.0F, 0.0F, 1.0F});
}

TEST(Tangent, TriangleWithoutUvAreaTakesItsNeighbours) {
    for (const float sign : {-1.0F, 1.0F}) {
        Corners corners = square(glm::mat2(sign, 0.0F, 0.0F, 1.0F));
        for (std::size_t i = 3; i < 6; ++i) corners[i].uv = corners[i == 4 ? 2 : 0].uv;
        const std::vector<glm::vec4> got = tangents_of(corners);
        expect_near(got[0], {sign, 0.0F, 0.0F, sign});
        expect_near(got[3], got[0]);
        expect_near(got[4], got[2]);
        EXPECT_EQ(got[5].w, sign);  // one sign in a triangle, also where it has no neighbour
        expect_frames(corners, got);
    }
}

/// A strip of triangles without uv area between a mirrored square and one that is not: each takes
/// the side of the nearer one, and its own three corners agree.
TEST(Tangent, SidesSpreadFromTheNearest) {
    Corners corners = square(glm::mat2(-1.0F, 0.0F, 0.0F, 1.0F));
    constexpr int kStrip = 6;
    for (int k = 1; k <= kStrip + 1; ++k) {
        for (Corner corner : square(glm::mat2(1.0F))) {
            corner.position.x += static_cast<float>(k);
            const bool flat = k <= kStrip;
            // Uvs along the strip's edges stay those of the first square's right edge, then those
            // of the last one's left edge, so that neighbours share their vertices.
            if (flat || corner.uv.x == 0.0F) corner.uv = {-1.0F, corner.uv.y};
            corners.push_back(corner);
        }
    }
    const std::vector<glm::vec4> got = tangents_of(corners);
    for (std::size_t i = 0; i < got.size(); i += 3) {
        EXPECT_EQ(got[i].w, got[i + 1].w) << i / 3;
        EXPECT_EQ(got[i].w, got[i + 2].w) << i / 3;
        // 12 triangles between: six to each side.
        EXPECT_EQ(got[i].w, i / 3 < 2 + kStrip ? -1.0F : 1.0F) << i / 3;
    }
}

TEST(Tangent, NothingToGoByGivesAUnitTangent) {
    Corners corners = square(glm::mat2(0.0F));
    expect_frames(corners, tangents_of(corners));
    // Facing +z, as the reference implementation has it.
    expect_near(tangents_of(corners)[0], {1.0F, 0.0F, 0.0F, 1.0F});
}

TEST(Tangent, MatchesTheExactFramesOfShapes) {
    const MeshData meshes[] = {shapes::sphere(200, 100, {1.0F, 0.7F, 1.3F}),
                               shapes::torus_knot(600, 60), shapes::plane(3, 5), shapes::cube()};
    for (const MeshData& mesh : meshes) {
        const Corners corners = corners_of(mesh);
        const std::vector<glm::vec4> got = tangents_of(corners);
        expect_frames(corners, got);
        double worst = 1.0;
        for (std::size_t i = 0; i < got.size(); ++i) {
            const glm::vec4& want = mesh.tangents[mesh.indices[i]];
            ASSERT_EQ(got[i].w, want.w);
            worst = std::min(worst, glm::dot(glm::dvec3(got[i]), glm::dvec3(want)));
        }
        // A chord is off its arc by half a step: 1.8 degrees of the sphere's column or less.
        EXPECT_GT(worst, std::cos(0.0315));
    }
}

/// Triangles in another order and starting at other corners: the same frames but for rounding.
TEST(Tangent, DoesNotDependOnTheOrderOfTrianglesOrCorners) {
    const Corners patch = bumpy_patch(12);
    const std::vector<glm::vec4> want = tangents_of(patch);
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::mt19937 engine(seed);
        std::vector<std::size_t> order(patch.size() / 3);
        std::iota(order.begin(), order.end(), 0U);
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[engine() % i]);
        std::vector<std::size_t> source;
        for (const std::size_t t : order) {
            const std::size_t turn = engine() % 3;
            for (std::size_t k = 0; k < 3; ++k) source.push_back(3 * t + (k + turn) % 3);
        }
        Corners shuffled;
        for (const std::size_t i : source) shuffled.push_back(patch[i]);
        const std::vector<glm::vec4> got = tangents_of(shuffled);
        for (std::size_t i = 0; i < got.size(); ++i) expect_near(got[i], want[source[i]]);
    }
}

TEST(Tangent, SignIsThatOfTheUvArea) {
    const Corners patch = bumpy_patch(9);
    const std::vector<glm::vec4> got = tangents_of(patch);
    bool seen[2] = {false, false};
    for (std::size_t i = 0; i < patch.size(); i += 3) {
        const glm::dvec2 a(patch[i].uv), ab = glm::dvec2(patch[i + 1].uv) - a,
                                         ac = glm::dvec2(patch[i + 2].uv) - a;
        const bool mirrored = ab.x * ac.y - ab.y * ac.x < 0.0;
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(got[i + k].w, mirrored ? -1.0F : 1.0F);
        seen[mirrored ? 1 : 0] = true;
    }
    EXPECT_TRUE(seen[0] && seen[1]);
}

TEST(Tangent, NeverNanOnGarbage) {
    constexpr float kInf = std::numeric_limits<float>::infinity();
    constexpr float kMax = std::numeric_limits<float>::max();
    const float values[] = {0.0F, -0.0F, 1.0F, -1.0F, 0.5F,          1e-38F, 1e-45F,
                            kMax, -kMax, kInf, -kInf, std::nanf(""), 1e-20F, 3.0F};
    for (unsigned seed = 0; seed < 300; ++seed) {
        std::mt19937 engine(seed);
        const auto pick = [&] { return values[engine() % std::size(values)]; };
        std::vector<Corner> pool(5);
        for (Corner& corner : pool) {
            for (int i = 0; i < 3; ++i) corner.position[i] = pick();
            for (int i = 0; i < 3; ++i) corner.normal[i] = pick();
            for (int i = 0; i < 2; ++i) corner.uv[i] = pick();
        }
        Corners corners;
        for (int i = 0; i < 36; ++i) corners.push_back(pool[engine() % pool.size()]);
        for (const glm::vec4& t : tangents_of(corners)) {
            const glm::dvec3 xyz(t);
            ASSERT_NEAR(glm::dot(xyz, xyz), 1.0, 1e-6) << "seed " << seed;
            ASSERT_EQ(std::abs(t.w), 1.0F) << "seed " << seed;
        }
    }
}

/// A fan of 100,000 triangles around one vertex, all on one edge besides: must not take square
/// time.
TEST(Tangent, ManyTrianglesAtOneVertexAndOneEdge) {
    Corners corners;
    for (int i = 0; i < 100'000; ++i) {
        const auto z = static_cast<float>(i);
        corners.push_back({{0.0F, 0.0F, 0.0F}, kUp, {0.0F, 0.0F}});
        corners.push_back({{1.0F, 0.0F, 0.0F}, kUp, {1.0F, 0.0F}});
        corners.push_back({{0.0F, 1.0F, z}, kUp, {0.0F, 1.0F}});
    }
    expect_frames(corners, tangents_of(corners));
}

TEST(Tangent, NoCorners) {
    EXPECT_TRUE(tangents_of({}).empty());
}

}  // namespace
}  // namespace burnish
