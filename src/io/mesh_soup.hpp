#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace burnish {

/// Index of an attribute that the file does not give.
inline constexpr std::uint32_t kNoIndex = 0xffffffffU;

/// One corner of a polygon: indices into the arrays of a MeshSoup, zero-based.
struct SoupCorner {
    std::uint32_t position;
    std::uint32_t uv;      ///< or kNoIndex
    std::uint32_t normal;  ///< or kNoIndex
};

/// What every mesh reader produces: polygons as the file has them. Position indices are in range;
/// values may be anything, NaN and infinity included.
struct MeshSoup {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> uvs;  ///< v upward
    std::vector<glm::vec3> normals;
    std::vector<SoupCorner> corners;         ///< of one polygon after the other
    std::vector<std::uint32_t> polygon_end;  ///< per polygon: index after its last corner
};

/// A file in memory, and the name to call it by in messages.
struct MeshText {
    std::string name;
    std::string_view bytes;
};

// The readers. All throw Error{bad_input} for bytes that make no sense.

/// Wavefront OBJ: v, vt, vn and f; everything else is ignored. Negative indices count back from the
/// last element read; a face may use elements that follow it.
MeshSoup parse_obj(const MeshText& file);
/// PLY, ASCII or binary of either byte order. Vertex x y z, nx ny nz, and u v | s t |
/// texture_u texture_v | texture_s texture_t; face vertex_indices | vertex_index and texcoord (a
/// list of u v pairs, one per corner).
MeshSoup parse_ply(const MeshText& file);
/// OFF with any of the prefixes ST, C, N and 4; vertex colours and face colours are ignored, a 4OFF
/// position is divided by its last component.
MeshSoup parse_off(const MeshText& file);
/// Whether `word` can open an OFF file: "OFF", "STOFF", "CNOFF" and so on.
bool is_off_keyword(std::string_view word);
/// STL, ASCII or binary. Facet normals are ignored: they only repeat the winding.
MeshSoup parse_stl(const MeshText& file);

}  // namespace burnish
