#include "shade/shown.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace burnish {

namespace {

std::uint8_t hash_byte(std::uint32_t h, int byte) {
    return static_cast<std::uint8_t>(h >> 8 * byte);
}

/// The same for the same two numbers, and far apart for neighbours.
std::uint32_t hash_of(std::uint32_t object, std::uint32_t triangle) {
    std::uint32_t h = triangle * 0x9e3779b1U ^ (object + 1) * 0x85ebca77U;
    h = (h ^ h >> 15) * 0x2c1b3c6dU;
    h = (h ^ h >> 12) * 0x297a2d39U;
    return h ^ h >> 15;
}

/// Channels of one pixel, not yet coded.
using Channels = std::array<float, 4>;

void write_pixel(const Channels& channels, std::uint16_t pixel, const OutputTile& tile) {
    const std::size_t at = 4 * std::size_t{pixel};
    if (tile.format == StoreFormat::rgba32f) {
        std::copy(channels.begin(), channels.end(), static_cast<float*>(tile.pixels) + at);
        return;
    }
    for (std::size_t c = 0; c < 4; ++c) {
        const float x = channels[c] > 0.0F ? std::min(channels[c], 1.0F) : 0.0F;
        if (tile.format == StoreFormat::rgba8) {
            static_cast<std::uint8_t*>(tile.pixels)[at + c] =
                static_cast<std::uint8_t>(x * 255.0F + 0.5F);
        } else {
            static_cast<std::uint16_t*>(tile.pixels)[at + c] =
                static_cast<std::uint16_t>(x * 65535.0F + 0.5F);
        }
    }
}

/// Channels of the fragments of a packet.
class ValueReader {
  public:
    ValueReader(const ShownValues& shown, const Packet& packet, const float* own_depths,
                bool floats)
        : m_shown(shown),
          m_aov(*shown.aov),
          m_count(shown.values.interpolated()),
          m_packet(packet),
          m_own_depths(own_depths),
          m_floats(floats) {}

    [[nodiscard]] Channels operator()(const ShownRun& run, int i) const {
        switch (m_aov) {
            case Aov::depth: {
                const float z = m_own_depths != nullptr ? m_own_depths[i] : depth(run.depth, i);
                return {z, z, z, 1.0F};
            }
            case Aov::normal:
                return normal(i);
            case Aov::tangent:
            case Aov::bitangent:
                return frame_axis(i);
            case Aov::stripes:
                return stripes(i);
            case Aov::uv:
                return coordinates(i);
            case Aov::triangle:
                return number(run);
        }
        return {};
    }

  private:
    /// As the kernels of the depth test have it.
    [[nodiscard]] float depth(const DepthRun& run, int i) const {
        const int pixel = m_packet.pixels[i];
        const auto dx = static_cast<float>((pixel & 7) + (pixel >> 3 & 56) + run.offset_x);
        const auto dy = static_cast<float>((pixel >> 3 & 7) + (pixel >> 6 & 56) + run.offset_y);
        const float z = (run.z + dx * run.zx) + dy * run.zy;
        return z < run.z_low ? run.z_low : z > run.z_high ? run.z_high : z;
    }
    [[nodiscard]] float attribute(int k, int i) const {
        return m_packet.attributes[k * kAttributeStride + i];
    }
    [[nodiscard]] glm::vec3 vector(int first, int i) const {
        return {attribute(first, i), attribute(first + 1, i), attribute(first + 2, i)};
    }
    [[nodiscard]] Channels coded(glm::vec3 v) const {
        const float length = std::sqrt((v.x * v.x + v.y * v.y) + v.z * v.z);
        v = length > 0.0F ? v / length : glm::vec3(0.0F);
        if (!m_floats) v = v * 0.5F + 0.5F;
        return {v.x, v.y, v.z, 1.0F};
    }
    [[nodiscard]] Channels normal(int i) const {
        return coded(m_count == 3 ? vector(0, i) : glm::vec3(0.0F));
    }

    struct Frame {
        glm::vec3 t, b, n;
    };
    [[nodiscard]] Frame frame(int i) const {
        Frame f{vector(kUvAttributes, i), vector(kUvAttributes + 3, i),
                vector(kUvAttributes + 6, i)};
        if (m_shown.orthonormal) make_orthonormal(f.t, f.b, f.n);
        return f;
    }
    [[nodiscard]] bool has_frames() const { return m_shown.values.frame_attributes > 0; }
    [[nodiscard]] Channels frame_axis(int i) const {
        if (!has_frames()) return coded(glm::vec3(0.0F));
        const Frame f = frame(i);
        return coded(m_shown.world_from_object * (m_aov == Aov::tangent ? f.t : f.b));
    }

    /// In every cell a stroke through its middle along the tangent that the fragment itself has;
    /// cells of every other row are moved by half.
    [[nodiscard]] Channels stripes(int i) const {
        constexpr int kCell = 16;  // pixels, a part of a tile
        const Channels none{0.5F, 0.5F, 0.5F, 1.0F};
        if (!has_frames()) return none;
        const Frame f = frame(i);
        const glm::vec4 at =
            m_shown.pixels_from_object * glm::vec4(vector(kUvAttributes + 9, i), 1.0F);
        const glm::vec4 step = m_shown.pixels_from_object * glm::vec4(f.t, 0.0F);
        // The derivative of (x / w, y / w), times w squared.
        const glm::vec2 way(step.x * at.w - at.x * step.w, step.y * at.w - at.y * step.w);
        const float length = std::sqrt(way.x * way.x + way.y * way.y);
        if (!(length > 0.0F)) return none;
        const float x = way.x / length, y = way.y / length;
        const int pixel = m_packet.pixels[i];
        const int row = (pixel >> 3 & 7) + (pixel >> 6 & 56);
        const int column = (pixel & 7) + (pixel >> 3 & 56) + row / kCell % 2 * (kCell / 2);
        const float dx = static_cast<float>(column % kCell) - 7.5F,
                    dy = static_cast<float>(row % kCell) - 7.5F;
        const float along = x * dx + y * dy, across = x * dy - y * dx;
        const bool stroke = std::abs(across) < 2.0F && std::abs(along) < 7.0F;
        const bool mirrored = glm::dot(glm::cross(f.n, f.t), f.b) < 0.0F;
        const float light = stroke ? 0.7F + along * (0.3F / 7.0F) : 0.15F;
        return {light, mirrored ? light * 0.55F : light, mirrored ? light * 0.1F : light, 1.0F};
    }
    [[nodiscard]] Channels coordinates(int i) const {
        float u = attribute(0, i), v = attribute(1, i);
        if (m_count == 3) {
            u = u / attribute(2, i);
            v = v / attribute(2, i);
        }
        if (!m_floats) {
            u = u - std::floor(u);
            v = v - std::floor(v);
        }
        return {u, v, 0.0F, 1.0F};
    }
    [[nodiscard]] Channels number(const ShownRun& run) const {
        if (m_floats) {
            return {static_cast<float>(run.triangle), static_cast<float>(run.object), 0.0F, 1.0F};
        }
        const std::uint32_t h = hash_of(run.object, run.triangle);
        const auto channel = [&](int byte) {
            return static_cast<float>(hash_byte(h, byte)) / 255.0F;
        };
        return {channel(0), channel(1), channel(2), 1.0F};
    }

    const ShownValues& m_shown;
    Aov m_aov;
    int m_count;
    const Packet& m_packet;
    const float* m_own_depths;
    bool m_floats;
};

/// Adds `count` values per vertex; `value(vertex)` gives them.
template <class F>
void fill_values(Shading& shading, std::size_t vertices, int count, F&& value) {
    for (int i = 0; i < count; ++i) shading.varying_list.push_back({Varying::Source::uv, i});
    shading.rows.resize(vertices, static_cast<std::size_t>(count));
    for (std::size_t v = 0; v < vertices; ++v) {
        const glm::vec3 x = value(v);
        for (int i = 0; i < count; ++i) shading.rows.row(v)[i] = x[i];
    }
}

}  // namespace

ShownValues shown_values(Aov aov, const Object& object, TangentFrames tangent_frames,
                         const glm::dmat4& pixels_from_world) {
    ShownValues shown{.aov = aov, .values = {}};
    if (const auto* raw = std::get_if<RawVertices>(&object.geometry)) {
        if (aov == Aov::uv) {
            fill_values(shown.values, raw->vertices.size(), 3, [&](std::size_t v) {
                const glm::vec4& uv = raw->vertices[v].uv[0];
                return glm::vec3(uv.x, uv.y, uv.w);
            });
        }
        return shown;
    }
    const auto& mesh = std::get<Mesh>(object.geometry);
    const std::span<const VertexFrame> frames = mesh.frames();
    const glm::mat3 world_from_object(object.world_from_object);
    if (aov == Aov::uv) {
        fill_values(shown.values, frames.size(), 2, [&](std::size_t v) {
            return glm::vec3(frames[v].uv.x, 1.0F - frames[v].uv.y, 0.0F);
        });
    } else if (aov == Aov::normal) {
        fill_values(shown.values, frames.size(), 3,
                    [&](std::size_t v) { return world_from_object * frames[v].normal; });
    } else if (aov == Aov::tangent || aov == Aov::bitangent || aov == Aov::stripes) {
        shown.values.frames = frames;
        shown.values.frame_attributes = kUvAttributes + kFrameAttributes;
        shown.values.frames_from_uv = tangent_frames == TangentFrames::derivative;
        shown.orthonormal = tangent_frames != TangentFrames::mikktspace;
        shown.world_from_object = world_from_object;
        shown.pixels_from_object =
            glm::mat4(pixels_from_world * glm::dmat4(object.world_from_object));
    }
    return shown;
}

glm::vec4 background_of(Aov aov) {
    return aov == Aov::depth ? glm::vec4(1.0F) : glm::vec4(0.0F);
}

void write_values(const ShownValues& shown, const Packet& packet, std::span<const ShownRun> runs,
                  const float* own_depths, const std::uint16_t* stored, const OutputTile& tile) {
    const ValueReader channels(shown, packet, own_depths, tile.format == StoreFormat::rgba32f);
    for (const ShownRun& run : runs) {
        for (int i = run.depth.first; i < run.depth.first + run.depth.count; ++i) {
            write_pixel(channels(run, i), stored[i], tile);
        }
    }
}

}  // namespace burnish
