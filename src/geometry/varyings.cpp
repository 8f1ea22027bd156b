#include "geometry/varyings.hpp"

#include <algorithm>
#include <cmath>

namespace burnish {

namespace {

float dot(const glm::vec3& a, const glm::vec3& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

glm::vec3 cross(const glm::vec3& a, const glm::vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Zero stays zero.
glm::vec3 normalised(const glm::vec3& v) {
    const float length = std::sqrt(dot(v, v));
    return length > 0.0F ? v * (1.0F / length) : v;
}

/// The number by which the kernel knows what a varying is; a mesh has no vertex colours.
std::int8_t vertex_value(const Varying& varying) {
    const auto component = [&](std::int8_t first) {
        return static_cast<std::int8_t>(first + varying.index);
    };
    switch (varying.source) {
        case Varying::Source::half_tangent:
            return component(VertexValue::half);
        case Varying::Source::light_tangent:
            return component(VertexValue::light);
        case Varying::Source::view_tangent:
            return component(VertexValue::view);
        case Varying::Source::half_sum:
            return component(VertexValue::half_sum);
        case Varying::Source::n_dot_l:
            return VertexValue::n_dot_l;
        case Varying::Source::h_dot_l:
            return VertexValue::h_dot_l;
        case Varying::Source::lit:
            return component(VertexValue::lit);
        case Varying::Source::normal:
            return component(VertexValue::normal);
        default:
            return VertexValue::none;
    }
}

/// What the vertices' rows get of light `light`, with the first light what they bring themselves,
/// for the kernel; empty if that is nothing. A row ends with a whole group of four, whose rest
/// repeats the last value.
std::vector<std::int8_t> vertex_values(int own_attributes, std::span<const Varying> list,
                                       int light) {
    std::vector<std::int8_t> values;
    for (int k = 0; k < own_attributes; ++k)
        values.push_back(light == 0 ? static_cast<std::int8_t>(VertexValue::uv + k)
                                    : VertexValue::none);
    for (const Varying& varying : list)
        values.push_back(varying.light == light ? vertex_value(varying) : VertexValue::none);
    const bool any = std::any_of(values.begin(), values.end(),
                                 [](std::int8_t v) { return v != VertexValue::none; });
    if (!any) return {};
    values.resize((values.size() + 3) / 4 * 4, values.back());
    return values;
}

LightVerticesCtx light_context(const LightInputs& inputs, const std::vector<std::int8_t>& values) {
    LightVerticesCtx ctx{};
    for (int c = 0; c < 3; ++c) {
        ctx.light[c] = inputs.space.light[c];
        ctx.eye[c] = inputs.space.eye[c];
        ctx.tint[c] = inputs.lit.tint[c];
        ctx.base[c] = inputs.lit.base[c];
    }
    ctx.light_w = inputs.space.light_w;
    ctx.eye_w = inputs.space.eye_w;
    ctx.orthonormal = inputs.rules.orthonormal ? 1 : 0;
    ctx.raw_half = inputs.rules.normalise_half ? 0 : 1;
    ctx.values = values.data();
    ctx.stride = static_cast<int>(values.size());
    return ctx;
}

/// A colour as the NV2A takes it: 0.1 and 0.3 become 25 and 76 of 255, a little below the half. The
/// captures fit any cut from 12 to 22 fraction bits; the finest harms interpolation least.
float cut_color(float x) {
    return std::floor(x * 0x1p22F) * 0x1p-22F;
}

float value_of(const RawVertex& v, const Varying& varying, NumberModel numbers) {
    const auto clamped = [&](float x) {
        const float color = x > 0.0F ? std::min(x, 1.0F) : 0.0F;
        return numbers == NumberModel::nine_bit ? cut_color(color) : color;
    };
    switch (varying.source) {
        case Varying::Source::color0:
            return clamped(v.color0[varying.index]);
        case Varying::Source::color1:
            return clamped(v.color1[varying.index]);
        case Varying::Source::uv:
            return v.uv[static_cast<std::size_t>(varying.index / 4)][varying.index % 4];
        default:
            return 0.0F;  // raw vertices have no normals
    }
}

}  // namespace

void make_orthonormal(glm::vec3& t, glm::vec3& b, glm::vec3& n) {
    n = normalised(n);
    t = normalised(t - n * dot(n, t));
    const glm::vec3 c = cross(n, t);
    b = dot(c, b) < 0.0F ? -c : c;
}

void mesh_rows(std::span<const VertexFrame> vertices, int own_attributes,
               std::span<const Varying> list, std::span<const LightInputs> lights,
               const KernelTable& kernels, WorkerPool& pool, VertexRows& out) {
    static_assert(sizeof(VertexFrame) == LightVerticesCtx::kFrameFloats * sizeof(float));
    static_assert(VertexValue::frame == VertexValue::uv + kUvAttributes);
    constexpr std::size_t kBatch = 1024;
    out.resize(vertices.size(),
               (static_cast<std::size_t>(own_attributes) + list.size() + 3) / 4 * 4);
    for (std::size_t light = 0; light < lights.size(); ++light) {
        const std::vector<std::int8_t> values =
            vertex_values(own_attributes, list, static_cast<int>(light));
        if (values.empty()) continue;
        const LightVerticesCtx whole = light_context(lights[light], values);
        const std::size_t batches = (vertices.size() + kBatch - 1) / kBatch;
        for_each_index(pool, batches, 1, [&](std::size_t batch, int) {
            const std::size_t first = batch * kBatch;
            LightVerticesCtx ctx = whole;
            ctx.frames = &vertices[first].position.x;
            ctx.count = static_cast<int>(std::min(kBatch, vertices.size() - first));
            ctx.out = out.row(first);
            kernels.light_vertices(ctx);
        });
    }
}

void raw_rows(std::span<const RawVertex> vertices, std::span<const Varying> list,
              NumberModel numbers, VertexRows& out) {
    out.resize(vertices.size(), list.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        float* to = out.row(v);
        for (const Varying& varying : list) *to++ = value_of(vertices[v], varying, numbers);
    }
}

}  // namespace burnish
