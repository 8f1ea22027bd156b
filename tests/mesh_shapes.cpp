#include <gtest/gtest.h>
#include <burnish/error.hpp>
#include <burnish/shapes.hpp>

#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace burnish {
namespace {

using Place = std::tuple<float, float, float>;

/// Counts directed edges between places: closed and manifold means each once, and its reverse once.
void expect_closed(const MeshData& mesh) {
    std::map<std::pair<Place, Place>, int> edges;
    const auto place = [&](std::size_t corner) {
        const glm::vec3& p = mesh.positions[mesh.indices[corner]];
        return Place(p.x, p.y, p.z);
    };
    for (std::size_t c = 0; c < mesh.indices.size(); ++c)
        ++edges[{place(c), place(c % 3 == 2 ? c - 2 : c + 1)}];
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        ASSERT_EQ(edges.count({edge.second, edge.first}), 1U);
    }
}

double volume(const MeshData& mesh) {
    double sum = 0.0;
    for (std::size_t c = 0; c < mesh.indices.size(); c += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[c]]), b(mesh.positions[mesh.indices[c + 1]]),
            d(mesh.positions[mesh.indices[c + 2]]);
        sum += glm::dot(a, glm::cross(b, d)) / 6.0;
    }
    return sum;
}

void expect_unit_frames(const MeshData& mesh) {
    ASSERT_NO_THROW(Mesh{mesh});
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3 n(mesh.normals[i]), t(mesh.tangents[i]);
        ASSERT_NEAR(glm::dot(n, n), 1.0, 1e-6);
        ASSERT_NEAR(glm::dot(t, t), 1.0, 1e-6);
        ASSERT_NEAR(glm::dot(n, t), 0.0, 1e-6);
        ASSERT_EQ(mesh.tangents[i].w, 1.0F);
    }
}

TEST(Shapes, SphereOfTheBenchmarkScene) {
    const MeshData mesh = shapes::sphere(144, 72);
    EXPECT_EQ(mesh.indices.size(), 3U * 20'448U);
    expect_unit_frames(mesh);
    expect_closed(mesh);
    // 4/3 pi less the caps between a sphere and its facets, of order (pi / 72)^2.
    EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * std::acos(-1.0), 0.005);
    for (const glm::vec3& p : mesh.positions) ASSERT_NEAR(glm::length(glm::dvec3(p)), 1.0, 1e-6);
}

TEST(Shapes, EllipsoidNormalIsTheGradient) {
    const glm::dvec3 radii(1.2, 0.8, 0.5);
    const MeshData mesh = shapes::sphere(16, 8, glm::vec3(radii));
    expect_closed(mesh);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3 p(mesh.positions[i]);
        const glm::dvec3 gradient = glm::normalize(p / (radii * radii));
        ASSERT_NEAR(glm::dot(gradient, glm::dvec3(mesh.normals[i])), 1.0, 1e-6);
    }
}

TEST(Shapes, TorusKnotIsClosedAndFacesOutward) {
    const MeshData mesh = shapes::torus_knot(300, 24);
    EXPECT_EQ(mesh.indices.size(), 3U * 2U * 300U * 24U);
    expect_unit_frames(mesh);
    expect_closed(mesh);
    EXPECT_GT(volume(mesh), 0.0);
    EXPECT_EQ(mesh.uvs[300].x, std::floor(mesh.uvs[300].x));  // whole periods: no seam to be seen
}

TEST(Shapes, CubeAndPlane) {
    const MeshData cube = shapes::cube();
    EXPECT_EQ(cube.indices.size(), 36U);
    EXPECT_EQ(volume(cube), 1.0);
    expect_closed(cube);
    expect_unit_frames(cube);
    const MeshData plane = shapes::plane(4, 3);
    EXPECT_EQ(plane.indices.size(), 3U * 24U);
    expect_unit_frames(plane);
}

TEST(Shapes, RibbonNormalsAreThoseOfItsFacets) {
    const MeshData mesh = shapes::ribbon(200, 2);
    EXPECT_EQ(mesh.indices.size(), 3U * 800U);
    expect_unit_frames(mesh);
    for (std::size_t c = 0; c < mesh.indices.size(); c += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[c]]), b(mesh.positions[mesh.indices[c + 1]]),
            d(mesh.positions[mesh.indices[c + 2]]);
        const glm::dvec3 facet = glm::normalize(glm::cross(b - a, d - a));
        // From its middle to its end a segment turns by 0.15 (3 pi)^2 / 2 / 400 = 0.0167 at most.
        EXPECT_GT(glm::dot(facet, glm::dvec3(mesh.normals[mesh.indices[c]])), 1.0 - 1.5e-4);
        EXPECT_GT(facet.z, 0.0);
    }
}

TEST(Shapes, RefusesWhatHasNoShape) {
    const auto code = [](auto make) {
        try {
            make();
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::io;
    };
    EXPECT_EQ(code([] { shapes::sphere(2, 5); }), ErrorCode::bad_option);
    EXPECT_EQ(code([] { shapes::sphere(8, 5, glm::vec3(1.0F, 0.0F, 1.0F)); }),
              ErrorCode::bad_option);
    EXPECT_EQ(code([] { shapes::plane(40'000, 40'000); }), ErrorCode::limit);
    EXPECT_EQ(code([] { shapes::torus_knot(9, 9, {.torus_radius = 1.5F}); }),
              ErrorCode::bad_option);
}

TEST(Mesh, RefusesWhatDoesNotFit) {
    MeshData mesh = shapes::cube();
    mesh.uvs.pop_back();
    EXPECT_THROW(Mesh{mesh}, Error);
    mesh = shapes::cube();
    mesh.indices.pop_back();
    EXPECT_THROW(Mesh{mesh}, Error);
    mesh = shapes::cube();
    mesh.indices[7] = 24;
    EXPECT_THROW(Mesh{mesh}, Error);
}

TEST(Mesh, PlanesAreAlignedAndPadded) {
    const MeshData data = shapes::plane(1, 7);  // 16 vertices: padding must not be zero lines
    const Mesh mesh(data);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float* plane = mesh.positions()[axis];
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(plane) % 64, 0U);
        for (std::size_t i = 0; i < mesh.vertex_count(); ++i)
            EXPECT_EQ(plane[i], data.positions[i][static_cast<int>(axis)]);
        for (std::size_t i = mesh.vertex_count(); i < 32; ++i) EXPECT_EQ(plane[i], 0.0F);
    }
}

TEST(Mesh, BoundsAreThoseOfFinitePositions) {
    MeshData data = shapes::cube();
    data.positions[3].y = std::nanf("");
    data.positions[0].x = HUGE_VALF;
    EXPECT_EQ(Mesh(data).bounds().low, glm::vec3(-0.5F));
    EXPECT_EQ(Mesh(data).bounds().high, glm::vec3(0.5F));
    EXPECT_GT(Mesh(MeshData{}).bounds().low.x, Mesh(MeshData{}).bounds().high.x);
    EXPECT_EQ(Mesh().triangle_count(), 0U);
}

}  // namespace
}  // namespace burnish
