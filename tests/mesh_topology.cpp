#include "io/mesh_topology.hpp"

#include <gtest/gtest.h>

#include <burnish/shapes.hpp>
#include <cstdint>
#include <map>
#include <random>
#include <tuple>

namespace burnish {
namespace {

/// Triangles of a shape by place: vertices that share a position are one.
PlacePolygons places_of(const MeshData& mesh) {
    std::map<std::tuple<float, float, float>, std::uint32_t> numbers;
    PlacePolygons polygons;
    for (const std::uint32_t i : mesh.indices) {
        const glm::vec3& p = mesh.positions[i];
        const auto number = static_cast<std::uint32_t>(numbers.size());
        polygons.places.push_back(numbers.try_emplace({p.x, p.y, p.z}, number).first->second);
        if (polygons.places.size() % 3 == 0)
            polygons.end.push_back(static_cast<std::uint32_t>(polygons.places.size()));
    }
    polygons.place_count = numbers.size();
    return polygons;
}

TEST(MeshTopology, ClosedShapesHaveNoBoundary) {
    for (const MeshData& mesh : {shapes::sphere(9, 6), shapes::torus_knot(30, 7), shapes::cube()}) {
        const PlacePolygons polygons = places_of(mesh);
        EXPECT_TRUE(suits_halfedges(polygons));
        EXPECT_EQ(halfedge_topology(polygons).boundary_edges, 0U);
        EXPECT_EQ(halfedge_topology(polygons).nonmanifold_faces, 0U);
    }
}

TEST(MeshTopology, BoundaryOfAGridIsItsRim) {
    const PlacePolygons polygons = places_of(shapes::plane(5, 3));
    EXPECT_EQ(halfedge_topology(polygons).boundary_edges, 16U);  // 5 + 3 + 5 + 3
    EXPECT_EQ(sorted_topology(polygons).boundary_edges, 16U);
}

/// Holes leave edges manifold, so both ways count the same edges, as long as no vertex is left in
/// two fans: the half-edge structure may refuse faces there.
TEST(MeshTopology, BothWaysAgreeOnMeshesWithHoles) {
    const MeshData knot = shapes::torus_knot(40, 9);
    int compared = 0;
    for (unsigned seed = 0; seed < 100; ++seed) {
        std::mt19937 engine(seed);
        MeshData holed;
        holed.positions = knot.positions;
        for (std::size_t i = 0; i < knot.indices.size(); i += 3)
            if (engine() % 40 != 0)
                holed.indices.insert(holed.indices.end(), knot.indices.begin() + std::ptrdiff_t(i),
                                     knot.indices.begin() + std::ptrdiff_t(i) + 3);
        const PlacePolygons polygons = places_of(holed);
        const MeshTopology by_halfedges = halfedge_topology(polygons);
        const MeshTopology by_sorting = sorted_topology(polygons);
        EXPECT_EQ(by_sorting.nonmanifold_faces, 0U);
        EXPECT_GT(by_sorting.boundary_edges, 0U);
        if (by_halfedges.nonmanifold_faces != 0) continue;
        EXPECT_EQ(by_halfedges.boundary_edges, by_sorting.boundary_edges) << "seed " << seed;
        ++compared;
    }
    EXPECT_GT(compared, 50);
}

TEST(MeshTopology, RefusesWhatHasNoPlace) {
    // Three triangles on the edge 0-1; two of them the same way round.
    const PlacePolygons book{5, {0, 1, 2, 1, 0, 3, 0, 1, 4}, {3, 6, 9}};
    EXPECT_EQ(halfedge_topology(book).nonmanifold_faces, 1U);  // the last one added
    EXPECT_EQ(sorted_topology(book).nonmanifold_faces, 3U);    // all at that edge
    // Neighbours with opposite winding.
    const PlacePolygons flipped{4, {0, 1, 2, 0, 1, 3}, {3, 6}};
    EXPECT_EQ(halfedge_topology(flipped).nonmanifold_faces, 1U);
    EXPECT_EQ(sorted_topology(flipped).nonmanifold_faces, 2U);
    // A polygon that visits a place twice.
    const PlacePolygons eight{5, {0, 1, 2, 0, 3, 4}, {6}};
    EXPECT_EQ(halfedge_topology(eight).nonmanifold_faces, 1U);
    EXPECT_EQ(sorted_topology(eight).nonmanifold_faces, 1U);
}

TEST(MeshTopology, SilentOnStandardError) {
    testing::internal::CaptureStderr();
    halfedge_topology({5, {0, 1, 2, 1, 0, 3, 0, 1, 4}, {3, 6, 9}});
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(MeshTopology, FanOfThousandsGoesBySorting) {
    PlacePolygons fan;
    constexpr std::uint32_t kBlades = 50'000;
    fan.place_count = kBlades + 2;
    for (std::uint32_t i = 0; i < kBlades; ++i) {
        fan.places.insert(fan.places.end(), {0, i + 1, i + 2});
        fan.end.push_back(3 * i + 3);
    }
    EXPECT_FALSE(suits_halfedges(fan));
    EXPECT_EQ(sorted_topology(fan).boundary_edges, kBlades + 2);  // the rim and both ends
}

}  // namespace
}  // namespace burnish
