#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/mesh.hpp>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/aligned.hpp"

namespace burnish {
namespace {

/// Lanes of the widest vectors, which read whole cache lines.
constexpr std::size_t kLanes = 16;
constexpr std::size_t kMaxCount = (std::size_t{1} << 31) - 1;

void check(const MeshData& data) {
    const std::size_t count = data.positions.size();
    if (data.normals.size() != count || data.uvs.size() != count || data.tangents.size() != count)
        throw Error(ErrorCode::bad_input,
                    fmt::format("mesh: {} positions, {} normals, {} uvs, {} tangents, expected as "
                                "many of each",
                                count, data.normals.size(), data.uvs.size(), data.tangents.size()));
    if (data.indices.size() % 3 != 0)
        throw Error(ErrorCode::bad_input,
                    fmt::format("mesh: {} indices, expected a multiple of 3", data.indices.size()));
    if (count > kMaxCount || data.indices.size() / 3 > kMaxCount)
        throw Error(ErrorCode::limit,
                    fmt::format("mesh: {} vertices and {} triangles, expected at most {}", count,
                                data.indices.size() / 3, kMaxCount));
    const auto outside = std::find_if(data.indices.begin(), data.indices.end(),
                                      [&](std::uint32_t index) { return index >= count; });
    if (outside != data.indices.end())
        throw Error(ErrorCode::bad_input,
                    fmt::format("mesh: index {} at {}, expected less than {}", *outside,
                                outside - data.indices.begin(), count));
}

Bounds finite_bounds(const std::vector<glm::vec3>& positions) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Bounds box{glm::vec3(kInfinity), glm::vec3(-kInfinity)};
    for (const glm::vec3& p : positions) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
        box.low = glm::min(box.low, p);
        box.high = glm::max(box.high, p);
    }
    return box;
}

constexpr Bounds kEmptyBounds{glm::vec3(std::numeric_limits<float>::infinity()),
                              glm::vec3(-std::numeric_limits<float>::infinity())};

}  // namespace

struct Mesh::Storage {
    AlignedVector<float> planes;  ///< x, y, z, each `pitch` long
    std::size_t pitch = 0;
    AlignedVector<VertexFrame> frames;
    AlignedVector<std::uint32_t> indices;
    Bounds bounds;
};

Mesh::Mesh(const MeshData& data) {
    check(data);
    const std::size_t count = data.positions.size();
    auto storage = std::make_shared<Storage>();
    storage->pitch = (count / kLanes + 1) * kLanes;
    storage->planes.resize(3 * storage->pitch);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float* plane = storage->planes.data() + axis * storage->pitch;
        for (std::size_t i = 0; i < count; ++i)
            plane[i] = data.positions[i][static_cast<glm::length_t>(axis)];
    }
    storage->frames.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        storage->frames.push_back(
            {data.positions[i], data.normals[i], data.tangents[i], data.uvs[i]});
    storage->indices.assign(data.indices.begin(), data.indices.end());
    storage->bounds = finite_bounds(data.positions);
    m_storage = std::move(storage);
}

std::size_t Mesh::vertex_count() const noexcept {
    return m_storage ? m_storage->frames.size() : 0;
}

std::size_t Mesh::triangle_count() const noexcept {
    return m_storage ? m_storage->indices.size() / 3 : 0;
}

Bounds Mesh::bounds() const noexcept {
    return m_storage ? m_storage->bounds : kEmptyBounds;
}

std::array<const float*, 3> Mesh::positions() const noexcept {
    if (!m_storage) return {nullptr, nullptr, nullptr};
    const float* x = m_storage->planes.data();
    return {x, x + m_storage->pitch, x + 2 * m_storage->pitch};
}

std::span<const VertexFrame> Mesh::frames() const noexcept {
    return m_storage ? std::span<const VertexFrame>(m_storage->frames)
                     : std::span<const VertexFrame>();
}

std::span<const std::uint32_t> Mesh::indices() const noexcept {
    return m_storage ? std::span<const std::uint32_t>(m_storage->indices)
                     : std::span<const std::uint32_t>();
}

}  // namespace burnish
