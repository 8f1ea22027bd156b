#include "io/mesh_topology.hpp"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <limits>
#include <mutex>
#include <tuple>

namespace burnish {
namespace {

/// Connectivity is all that is asked of it: no attributes, and positions stay unset.
struct ConnectivityTraits : OpenMesh::DefaultTraits {
    VertexAttributes(OpenMesh::Attributes::None);
    HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
    EdgeAttributes(OpenMesh::Attributes::None);
    FaceAttributes(OpenMesh::Attributes::None);
};
using HalfedgeMesh = OpenMesh::PolyMesh_ArrayKernelT<ConnectivityTraits>;

/// OpenMesh reports a refused face on std::cerr; the caller gets a count instead.
void silence_openmesh() {
    static std::once_flag once;
    std::call_once(once, [] { omerr().disable(); });
}

template <class Visit>
void for_each_polygon(const PlacePolygons& polygons, const Visit& visit) {
    std::size_t begin = 0;
    for (const std::uint32_t end : polygons.end) {
        visit(std::span(polygons.places).subspan(begin, end - begin));
        begin = end;
    }
}

/// add_face asserts on a corner that follows itself, and a place met twice is not manifold anyway.
class RepeatFinder {
  public:
    explicit RepeatFinder(std::size_t place_count) : m_last_seen(place_count, 0) {}
    bool repeats(std::span<const std::uint32_t> polygon) {
        ++m_polygon;
        bool found = false;
        for (const std::uint32_t place : polygon) {
            found = found || m_last_seen[place] == m_polygon;
            m_last_seen[place] = m_polygon;
        }
        return found;
    }

  private:
    std::vector<std::uint32_t> m_last_seen;
    std::uint32_t m_polygon = 0;
};

}  // namespace

bool suits_halfedges(const PlacePolygons& polygons) {
    constexpr std::size_t kMostCorners = std::size_t{1} << 29;  // OpenMesh counts half-edges in int
    if (polygons.places.size() > kMostCorners) return false;
    std::vector<std::uint64_t> valence(polygons.place_count, 0);
    for (const std::uint32_t place : polygons.places) ++valence[place];
    std::uint64_t steps = 0;
    for (const std::uint64_t v : valence) steps += v * v;
    // A regular mesh takes 6 steps per corner; this is some tenths of a second.
    return steps <= 64 * polygons.places.size() + 100'000'000;
}

MeshTopology halfedge_topology(const PlacePolygons& polygons) {
    silence_openmesh();
    MeshTopology result;
    HalfedgeMesh mesh;
    mesh.reserve(polygons.place_count, polygons.places.size() / 2 + polygons.place_count,
                 polygons.end.size());
    for (std::size_t i = 0; i < polygons.place_count; ++i) mesh.new_vertex();
    RepeatFinder finder(polygons.place_count);
    std::vector<OpenMesh::VertexHandle> handles;
    for_each_polygon(polygons, [&](std::span<const std::uint32_t> polygon) {
        handles.clear();
        for (const std::uint32_t place : polygon) handles.emplace_back(static_cast<int>(place));
        if (finder.repeats(polygon) || !mesh.add_face(handles).is_valid())
            ++result.nonmanifold_faces;
    });
    for (const auto edge : mesh.edges())
        if (mesh.is_boundary(edge)) ++result.boundary_edges;
    return result;
}

MeshTopology sorted_topology(const PlacePolygons& polygons) {
    struct Side {
        std::uint32_t low, high, polygon;
        bool upward;
    };
    std::vector<Side> sides;
    sides.reserve(polygons.places.size());
    std::vector<bool> refused(polygons.end.size(), false);
    RepeatFinder finder(polygons.place_count);
    std::uint32_t number = 0;
    for_each_polygon(polygons, [&](std::span<const std::uint32_t> polygon) {
        refused[number] = finder.repeats(polygon);
        for (std::size_t i = 0; i < polygon.size() && !refused[number]; ++i) {
            const std::uint32_t from = polygon[i], to = polygon[(i + 1) % polygon.size()];
            sides.push_back({std::min(from, to), std::max(from, to), number, from < to});
        }
        ++number;
    });
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.polygon) < std::tie(b.low, b.high, b.polygon);
    });
    MeshTopology result;
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
        while (last < sides.size() && sides[last].low == sides[first].low &&
               sides[last].high == sides[first].high)
            ++last;
        if (last - first == 1) ++result.boundary_edges;
        if (last - first == 2 && sides[first].upward != sides[first + 1].upward) continue;
        if (last - first > 1)
            for (std::size_t i = first; i < last; ++i) refused[sides[i].polygon] = true;
    }
    result.nonmanifold_faces =
        static_cast<std::size_t>(std::count(refused.begin(), refused.end(), true));
    return result;
}

}  // namespace burnish
