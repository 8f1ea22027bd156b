#pragma once

#include <burnish/mesh.hpp>
#include <burnish/scene.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/aligned.hpp"
#include "core/parallel.hpp"
#include "kernels/kernel_table.hpp"

namespace burnish {

/// The light and the eye where a draw's vertices are: object space.
struct LightSpace {
    glm::vec3 light{0.0F, 0.0F, 1.0F};  ///< position, or the direction towards the light
    float light_w = 0.0F;               ///< 1: position, 0: direction
    glm::vec3 eye{0.0F};
    float eye_w = 1.0F;  ///< 1: position, 0: direction towards the viewer
};

/// Which vectors a machine makes of them.
struct VectorRules {
    bool normalise_half = true;  ///< else (l + v) / 2
    bool orthonormal = false;    ///< frames of vertices are made so, as LightingCtx has it
};

/// One float that a vertex hands to the interpolators.
struct Varying {
    enum class Source : std::uint8_t {
        color0,  ///< raw vertices: component `index`
        color1,
        uv,            ///< raw vertices: component index % 4 of coordinates index / 4
        half_tangent,  ///< component `index` of the half vector in the tangent frame, x/2 + 1/2
        light_tangent,
        view_tangent,
        half_sum,  ///< component `index` of (l + v) / 2 in the tangent frame, neither unit nor
                   ///< coded
        n_dot_l,   ///< max(0, normal . light)
        h_dot_l,   ///< max(0, half vector . light)
        lit,       ///< n_dot_l * tint + base
        normal,    ///< component `index`, object space, x/2 + 1/2
    };
    Source source;
    int index;
    int light = 0;  ///< whose it is; 0 for what no light changes
    friend bool operator==(const Varying&, const Varying&) = default;
};

/// What `lit` multiplies and adds.
struct LitColors {
    glm::vec3 tint{1.0F}, base{0.0F};
};

/// What vertices and pixels need to know of a light.
struct LightInputs {
    LightSpace space;
    LitColors lit;
    VectorRules rules = {};
};

/// What the vertices of a draw hand to the interpolators, vertex by vertex.
struct VertexRows {
    static constexpr std::size_t kSlack = 3;  ///< kernels read past the last row

    AlignedVector<float> values;  ///< `stride` for each vertex, and kSlack more
    std::size_t stride = 0;       ///< at least the attributes

    void resize(std::size_t vertices, std::size_t row) {
        stride = row;
        values.resize(vertices * row + kSlack);
    }
    [[nodiscard]] float* row(std::size_t vertex) { return values.data() + vertex * stride; }
    [[nodiscard]] const float* row(std::size_t vertex) const {
        return values.data() + vertex * stride;
    }
};

/// Attributes that a mesh's vertices bring themselves: uv and, where light meets the tangent frame
/// at every pixel, T, B, N and the position.
inline constexpr int kUvAttributes = 2;
inline constexpr int kFrameAttributes = 12;

/// The first `own_attributes` (0, kUvAttributes, or with kFrameAttributes) that vertices bring
/// themselves, v growing downward, and the values of `list`, which names nothing that only raw
/// vertices have. Vectors of lights are unit length at the vertex.
void mesh_rows(std::span<const VertexFrame> vertices, int own_attributes,
               std::span<const Varying> list, std::span<const LightInputs> lights,
               const KernelTable& kernels, WorkerPool& pool, VertexRows& out);
/// Values of `list`. Colours are clamped to [0, 1]; nine-bit machines drop what lies below 2^-22.
void raw_rows(std::span<const RawVertex> vertices, std::span<const Varying> list,
              NumberModel numbers, VertexRows& out);

/// The frame made orthonormal as LightingCtx has it; vectors without length stay so.
void make_orthonormal(glm::vec3& t, glm::vec3& b, glm::vec3& n);

}  // namespace burnish
