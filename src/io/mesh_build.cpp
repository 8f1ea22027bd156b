#include "io/mesh_build.hpp"

#include <algorithm>
#include <cmath>

#include "io/mesh_text.hpp"
#include "io/mesh_topology.hpp"
#include "io/mesh_triangulate.hpp"
#include "mesh/chart.hpp"
#include "mesh/normals.hpp"
#include "mesh/tangent_groups.hpp"
#include "mesh/weld.hpp"

namespace burnish {
namespace {

template <class Vector>
bool finite(const Vector& v) {
    for (glm::length_t i = 0; i < v.length(); ++i)
        if (!std::isfinite(v[i])) return false;
    return true;
}

/// Gives equal positions one index: files repeat them at seams and, in STL, for every facet.
void weld_positions(MeshSoup& soup) {
    const Weld same = weld(soup.positions.size(), [&](std::size_t i) {
        const glm::vec3& p = soup.positions[i];
        return std::array{key_bits(p.x), key_bits(p.y), key_bits(p.z)};
    });
    std::vector<glm::vec3> places;
    places.reserve(same.first.size());
    for (const std::uint32_t i : same.first) places.push_back(soup.positions[i]);
    soup.positions = std::move(places);
    for (SoupCorner& corner : soup.corners) corner.position = same.id[corner.position];
}

/// Makes normals unit length; corners whose normal has no direction, or whose uv is not finite, go
/// without.
void drop_bad_attributes(MeshSoup& soup) {
    std::vector<bool> bad(soup.normals.size(), false);
    for (std::size_t i = 0; i < soup.normals.size(); ++i) {
        const glm::dvec3 n(soup.normals[i]);
        const double square = glm::dot(n, n);
        bad[i] = !(square > 0.0) || !std::isfinite(square);
        // Writers round each component: what is unit length but for that keeps its bits.
        constexpr double kRounding = 1e-6;
        if (!bad[i] && std::abs(square - 1.0) > kRounding)
            soup.normals[i] = glm::vec3(n / std::sqrt(square));
    }
    for (SoupCorner& corner : soup.corners) {
        if (corner.normal != kNoIndex && bad[corner.normal]) corner.normal = kNoIndex;
        if (corner.uv != kNoIndex && !finite(soup.uvs[corner.uv])) corner.uv = kNoIndex;
    }
}

MeshTopology topology(const MeshSoup& soup, std::span<const std::uint32_t> kept) {
    PlacePolygons polygons;
    polygons.place_count = soup.positions.size();
    polygons.places.reserve(soup.corners.size());
    polygons.end.reserve(kept.size());
    for (const std::uint32_t k : kept) {
        const std::uint32_t begin = k == 0 ? 0 : soup.polygon_end[k - 1];
        for (std::uint32_t c = begin; c < soup.polygon_end[k]; ++c)
            polygons.places.push_back(soup.corners[c].position);
        polygons.end.push_back(static_cast<std::uint32_t>(polygons.places.size()));
    }
    return suits_halfedges(polygons) ? halfedge_topology(polygons) : sorted_topology(polygons);
}

std::vector<std::uint32_t> places_of(std::span<const SoupCorner> corners) {
    std::vector<std::uint32_t> places;
    places.reserve(corners.size());
    for (const SoupCorner& corner : corners) places.push_back(corner.position);
    return places;
}

void add_missing_normals(MeshSoup& soup, SoupTriangles& triangles) {
    const CornerNormals made =
        corner_normals(soup.positions, places_of(triangles.corners), triangles.face_normals);
    const auto first = static_cast<std::uint32_t>(soup.normals.size());
    soup.normals.insert(soup.normals.end(), made.normals.begin(), made.normals.end());
    for (std::size_t c = 0; c < triangles.corners.size(); ++c) {
        std::uint32_t& normal = triangles.corners[c].normal;
        if (normal == kNoIndex) normal = first + made.normal_of_corner[c];
    }
}

bool lacks_uv(const SoupCorner& corner) {
    return corner.uv == kNoIndex;
}

/// A triangle with uvs at some corners only gets new ones at all three.
void add_missing_uvs(MeshSoup& soup, SoupTriangles& triangles) {
    // Places that no triangle uses may be infinite.
    for (glm::vec3& place : soup.positions)
        if (!finite(place)) place = soup.positions[triangles.corners[0].position];
    const std::vector<glm::vec2> made =
        chart_uvs(soup.positions, places_of(triangles.corners), triangles.face_normals);
    const auto first = static_cast<std::uint32_t>(soup.uvs.size());
    soup.uvs.insert(soup.uvs.end(), made.begin(), made.end());
    for (std::uint32_t c = 0; c < triangles.corners.size(); c += 3) {
        SoupCorner* corners = triangles.corners.data() + c;
        if (std::none_of(corners, corners + 3, lacks_uv)) continue;
        for (std::uint32_t i = 0; i < 3; ++i) corners[i].uv = first + c + i;
    }
}

WeldedTriangles weld_corners(const MeshSoup& soup, std::span<const SoupCorner> corners) {
    Weld same = weld(corners.size(), [&](std::size_t i) {
        const glm::vec3& n = soup.normals[corners[i].normal];
        const glm::vec2& uv = soup.uvs[corners[i].uv];
        // Positions are distinct, so their numbers stand for them.
        return std::array{corners[i].position, key_bits(n.x),  key_bits(n.y),
                          key_bits(n.z),       key_bits(uv.x), key_bits(uv.y)};
    });
    WeldedTriangles mesh;
    mesh.indices = std::move(same.id);
    mesh.positions.reserve(same.first.size());
    mesh.normals.reserve(same.first.size());
    mesh.uvs.reserve(same.first.size());
    for (const std::uint32_t c : same.first) {
        mesh.positions.push_back(soup.positions[corners[c].position]);
        mesh.normals.push_back(soup.normals[corners[c].normal]);
        mesh.uvs.push_back(soup.uvs[corners[c].uv]);
    }
    return mesh;
}

/// A tangent group is a vertex: it has one position, normal, uv and tangent.
MeshData with_tangents(const WeldedTriangles& welded) {
    TangentGroups groups = tangent_groups(welded);
    MeshData mesh;
    mesh.indices = std::move(groups.group_of_corner);
    mesh.tangents = std::move(groups.tangent_of_group);
    const std::size_t count = groups.vertex_of_group.size();
    mesh.positions.reserve(count);
    mesh.normals.reserve(count);
    mesh.uvs.reserve(count);
    for (const std::uint32_t vertex : groups.vertex_of_group) {
        mesh.positions.push_back(welded.positions[vertex]);
        mesh.normals.push_back(welded.normals[vertex]);
        mesh.uvs.push_back(welded.uvs[vertex]);
    }
    return mesh;
}

}  // namespace

MeshData build_mesh(const MeshText& file, MeshSoup soup, MeshReport& report) {
    report.polygons = soup.polygon_end.size();
    report.nonfinite_vertices =
        static_cast<std::size_t>(std::count_if(soup.positions.begin(), soup.positions.end(),
                                               [](const glm::vec3& p) { return !finite(p); }));
    weld_positions(soup);
    drop_bad_attributes(soup);
    SoupTriangles triangles = triangulate(soup, report);
    report.triangles = triangles.corners.size() / 3;
    if (triangles.corners.empty()) mesh_error(file, 0, "no triangle to draw");

    const MeshTopology found = topology(soup, triangles.polygons);
    report.boundary_edges = found.boundary_edges;
    report.nonmanifold_faces = found.nonmanifold_faces;

    const std::vector<SoupCorner>& corners = triangles.corners;
    report.generated_normals =
        std::any_of(corners.begin(), corners.end(),
                    [](const SoupCorner& corner) { return corner.normal == kNoIndex; });
    if (report.generated_normals) add_missing_normals(soup, triangles);
    report.generated_uvs = std::any_of(corners.begin(), corners.end(), lacks_uv);
    if (report.generated_uvs) add_missing_uvs(soup, triangles);
    return with_tangents(weld_corners(soup, corners));
}

}  // namespace burnish
