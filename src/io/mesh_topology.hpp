#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace burnish {

/// Polygons by the places of their corners alone: corners of polygon k are places[end[k - 1]] up to
/// places[end[k]].
struct PlacePolygons {
    std::size_t place_count = 0;
    std::vector<std::uint32_t> places;  ///< of one polygon after the other, at least 3 each
    std::vector<std::uint32_t> end;
};

/// How the polygons hang together.
struct MeshTopology {
    std::size_t boundary_edges = 0;     ///< with a polygon on one side only
    std::size_t nonmanifold_faces = 0;  ///< polygons that the structure has no room for
};

/// Through OpenMesh's half-edge structure: polygons are added in order; one that would make an edge
/// or a vertex "complex", or that visits a place twice, is refused and counted. Takes time in the
/// square of the number of polygons at one place: see `suits_halfedges`.
MeshTopology halfedge_topology(const PlacePolygons& polygons);

/// Whether halfedge_topology answers in time.
bool suits_halfedges(const PlacePolygons& polygons);

/// By sorting edges, whatever the polygons are: refuses polygons that have an edge with more than
/// two polygons, or with two that run along it in the same direction. Sees no complex vertices.
MeshTopology sorted_topology(const PlacePolygons& polygons);

}  // namespace burnish
