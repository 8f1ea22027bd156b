#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

namespace burnish {

/// Triangles with everything the renderer needs, as plain arrays that a caller can fill.
///
/// A vertex is one distinct combination of position, normal, uv and tangent, so seams are simply
/// vertices that share a position. The four attribute arrays have the same length.
struct MeshData {
    std::vector<glm::vec3> positions;  ///< object space
    std::vector<glm::vec3> normals;    ///< unit length, object space
    std::vector<glm::vec2> uvs;        ///< v grows upward, as in OBJ, PLY and OFF files
    std::vector<glm::vec4>
        tangents;  ///< xyz unit tangent, w = +1 or -1: bitangent = w * cross(n, t)
    std::vector<std::uint32_t>
        indices;  ///< three per triangle, counter-clockwise seen from outside
};

/// Axis-aligned box in object space; `low` > `high` when it is empty.
struct Bounds {
    glm::vec3 low;
    glm::vec3 high;
};

/// What a vertex carries besides its position; one array element per vertex.
struct VertexFrame {
    glm::vec3 position;
    glm::vec3 normal;
    glm::vec4 tangent;
    glm::vec2 uv;
};

/// Triangles ready to draw: immutable, cheap to copy (copies share their storage), safe to use from
/// several threads.
class Mesh {
  public:
    Mesh() = default;

    /// Throws Error{bad_input} if the attribute arrays differ in length, if `indices` is not a
    /// multiple of three, or if an index lies outside the arrays; Error{limit} above 2^31 - 1
    /// vertices or triangles. Non-finite values are allowed: their triangles are dropped, and
    /// counted, when a frame is drawn.
    explicit Mesh(const MeshData& data);

    [[nodiscard]] std::size_t vertex_count() const noexcept;
    [[nodiscard]] std::size_t triangle_count() const noexcept;
    /// Box of the finite positions.
    [[nodiscard]] Bounds bounds() const noexcept;

    /// Position components, structure of arrays: `vertex_count()` values, readable to the next
    /// multiple of 16 beyond.
    [[nodiscard]] std::array<const float*, 3> positions() const noexcept;
    [[nodiscard]] std::span<const VertexFrame> frames() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> indices() const noexcept;

  private:
    struct Storage;
    std::shared_ptr<const Storage> m_storage;
};

}  // namespace burnish
