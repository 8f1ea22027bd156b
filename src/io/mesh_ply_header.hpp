#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/mesh_soup.hpp"

namespace burnish {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of a value in a binary file.
std::size_t ply_size(PlyType type);
inline bool is_float(PlyType type) {
    return type >= PlyType::float32;
}

/// What burnish does with a property.
enum class PlyRole : std::uint8_t { x, y, z, nx, ny, nz, u, v, vertex_indices, texcoord, ignored };

struct PlyProperty {
    PlyRole role = PlyRole::ignored;
    bool is_list = false;
    PlyType count_type = PlyType::uint8;  ///< lists only
    PlyType type = PlyType::float32;      ///< of the value or of the list's items
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::size_t line = 0;  ///< where the header declares it
    std::vector<PlyProperty> properties;

    [[nodiscard]] bool has(PlyRole role) const;
};

enum class PlyFormat : std::uint8_t { ascii, binary_little_endian, binary_big_endian };

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::size_t line_count = 0;   ///< lines of the header
    std::size_t body_offset = 0;  ///< first byte after it

    /// Null if there is no such element.
    [[nodiscard]] const PlyElement* find(std::string_view name) const;
};

/// Throws Error{bad_input} for a malformed header, for one without vertex positions, and for counts
/// that the rest of the file is too small to hold.
PlyHeader parse_ply_header(const MeshText& file);

}  // namespace burnish
