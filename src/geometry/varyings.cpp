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

/// Everything that a lit vertex may be asked for.
struct LitVertex {
    glm::vec3 normal{};                 // object space, x/2 + 1/2
    glm::vec3 half{}, light{}, view{};  // in the tangent frame, likewise
    glm::vec3 half_sum{};               // in the tangent frame
    float n_dot_l = 0.0F, h_dot_l = 0.0F;
};

/// Which vectors of one light a list of varyings names.
struct WantedVectors {
    WantedVectors(std::span<const Varying> list, int of_light) {
        for (const Varying& v : list) {
            if (v.light != of_light) continue;
            any = true;
            half |= v.source == Varying::Source::half_tangent ||
                    v.source == Varying::Source::half_sum || v.source == Varying::Source::h_dot_l;
            light |= v.source == Varying::Source::light_tangent;
            view |= v.source == Varying::Source::view_tangent;
        }
    }
    bool any = false, half = false, light = false, view = false;
};

/// The frame of a vertex as the machine takes it.
struct Frame {
    Frame(const VertexFrame& v, bool orthonormal) : t(v.tangent), b(bitangent(v)), n(v.normal) {
        if (orthonormal) make_orthonormal(t, b, n);
    }
    [[nodiscard]] glm::vec3 in_frame(const glm::vec3& x) const {
        return {dot(t, x), dot(b, x), dot(n, x)};
    }
    glm::vec3 t, b, n;
};

LitVertex light_vertex(const VertexFrame& v, const LightInputs& inputs,
                       const WantedVectors& wanted) {
    const LightSpace& space = inputs.space;
    const Frame frame(v, inputs.rules.orthonormal);
    const auto coded = [&](const glm::vec3& x) { return frame.in_frame(x) * 0.5F + 0.5F; };
    const glm::vec3 l = normalised(space.light - v.position * space.light_w);
    LitVertex lit{.normal = v.normal * 0.5F + 0.5F, .n_dot_l = std::max(dot(frame.n, l), 0.0F)};
    if (wanted.light) lit.light = coded(l);
    if (!wanted.half && !wanted.view) return lit;
    const glm::vec3 view = normalised(space.eye - v.position * space.eye_w);
    if (wanted.half) {
        const glm::vec3 sum = l + view;
        const glm::vec3 half = inputs.rules.normalise_half ? normalised(sum) : sum * 0.5F;
        lit.half_sum = frame.in_frame(sum * 0.5F);
        lit.half = coded(half);
        lit.h_dot_l = std::max(dot(half, l), 0.0F);
    }
    if (wanted.view) lit.view = coded(view);
    return lit;
}

float value_of(const LitVertex& v, const Varying& varying, const LitColors& lit) {
    switch (varying.source) {
        case Varying::Source::half_tangent:
            return v.half[varying.index];
        case Varying::Source::light_tangent:
            return v.light[varying.index];
        case Varying::Source::view_tangent:
            return v.view[varying.index];
        case Varying::Source::half_sum:
            return v.half_sum[varying.index];
        case Varying::Source::n_dot_l:
            return v.n_dot_l;
        case Varying::Source::h_dot_l:
            return v.h_dot_l;
        case Varying::Source::lit:
            return v.n_dot_l * lit.tint[varying.index] + lit.base[varying.index];
        case Varying::Source::normal:
            return v.normal[varying.index];
        default:
            return 0.0F;  // a mesh has no vertex colours
    }
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

glm::vec3 bitangent(const VertexFrame& v) {
    return cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w;
}

void mesh_varyings(std::span<const VertexFrame> vertices, std::span<const Varying> list,
                   std::span<const LightInputs> lights, WorkerPool& pool, std::vector<float>& out) {
    constexpr std::size_t kBatch = 1024;
    out.resize(vertices.size() * list.size());
    if (list.empty()) return;
    for_each_index(pool, (vertices.size() + kBatch - 1) / kBatch, 1, [&](std::size_t batch, int) {
        const std::size_t last = std::min(vertices.size(), (batch + 1) * kBatch);
        for (int light = 0; light < static_cast<int>(lights.size()); ++light) {
            const WantedVectors wanted(list, light);
            if (!wanted.any) continue;
            const LightInputs& inputs = lights[static_cast<std::size_t>(light)];
            for (std::size_t i = batch * kBatch; i < last; ++i) {
                const LitVertex v = light_vertex(vertices[i], inputs, wanted);
                float* to = out.data() + i * list.size();
                for (const Varying& varying : list) {
                    if (varying.light == light) *to = value_of(v, varying, inputs.lit);
                    ++to;
                }
            }
        }
    });
}

void raw_varyings(std::span<const RawVertex> vertices, std::span<const Varying> list,
                  NumberModel numbers, std::vector<float>& out) {
    out.clear();
    out.reserve(vertices.size() * list.size());
    for (const RawVertex& v : vertices) {
        for (const Varying& varying : list) out.push_back(value_of(v, varying, numbers));
    }
}

}  // namespace burnish
