#include "trace/exact_inputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "trace/texel_bytes.hpp"

namespace burnish {

namespace {

/// NaN gives 0.
double clamp_to_one(double x) {
    return x > 0.0 ? std::min(x, 1.0) : 0.0;
}

struct TexelPosition {
    int texel;      ///< upper or left
    double weight;  ///< of its neighbour
};

/// The address stage with all bits of the weight.
TexelPosition texel_position(double u, int size, AddressMode mode, bool linear) {
    const bool repeat = mode == AddressMode::repeat;
    const double x = clamp_to_one(repeat ? u - std::floor(u) : u) * size - (linear ? 0.5 : 0.0);
    const double left = std::floor(x);
    const int texel = static_cast<int>(left);
    const double weight = linear ? x - left : 0.0;
    if (texel < 0) return repeat ? TexelPosition{size - 1, weight} : TexelPosition{0, 0.0};
    if (texel >= size) return {repeat ? 0 : size - 1, weight};
    return {texel, weight};
}

double mix(double a, double b, double weight) {
    return a + (b - a) * weight;
}

}  // namespace

ExactInputs::ExactInputs(const Shading& shading, const SetupTriangle& triangle,
                         const Barycentrics& place)
    : m_shading(shading),
      m_attributes(kMaxAttributes),
      m_planes(static_cast<std::size_t>(shading.program.plane_count)) {
    std::array<std::array<float, kMaxInterpolated>, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) {
        vertex_attributes(shading, triangle.vertex[i], corner[i].data());
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(shading.interpolated()); ++k) {
        for (std::size_t i = 0; i < 3; ++i) {
            m_attributes[k] += place.weight[i] * static_cast<double>(corner[i][k]);
        }
    }
}

void ExactInputs::feed(const InputOp& op) {
    struct Feed {
        ExactInputs& to;
        double& plane(int k) const { return to.m_planes[static_cast<std::size_t>(k)]; }
        void operator()(const ClearCtx& c) const { plane(c.plane) = 0.0; }
        void operator()(const LightingCtx& c) const { to.light(c); }
        void operator()(const EncodeCtx& c) const {
            plane(c.plane) = clamp_to_one(attribute(c.attribute));
        }
        void operator()(const AddressCtx& c) const { to.locate(c); }
        void operator()(const FetchCtx& c) const { to.fetch(c); }
        void operator()(const CopyCtx& c) const { plane(c.to) = plane(c.from); }
        void operator()(const FillCtx& c) const {
            attribute(c.attribute) = static_cast<double>(c.value);
        }
        void operator()(const DecodeCtx& c) const {
            attribute(c.attribute) = to.number(plane(c.plane), c.reading);
        }
        void operator()(const AffineCtx& c) const {
            attribute(c.to) =
                (attribute(c.from) * static_cast<double>(c.scale) + static_cast<double>(c.offset)) /
                static_cast<double>(c.divisor);
        }
        void operator()(const DotCtx& c) const {
            attribute(c.to) = glm::dot(vector(c.a), vector(c.b));
        }
        void operator()(const HemisphereCtx& c) const {
            const double x = attribute(c.x), y = attribute(c.y);
            attribute(c.to) = std::sqrt(std::max(1.0 - x * x - y * y, 0.0));
        }
        void operator()(const OffsetCtx& c) const {
            const double q = c.q < 0 ? 1.0 : attribute(c.q);
            const double ds = attribute(c.ds), dt = attribute(c.dt);
            const auto m = [&](int k) { return static_cast<double>(c.m[k]); };
            attribute(c.to) = attribute(c.s) / q + m(0) * ds + m(2) * dt;
            attribute(c.to + 1) = attribute(c.t) / q + m(1) * ds + m(3) * dt;
        }
        void operator()(const ReflectCtx& c) const {
            const glm::dvec3 n = vector(c.n), e = vector(c.e);
            const glm::dvec3 r = 2.0 * n * glm::dot(n, e) / glm::dot(n, n) - e;
            for (int k = 0; k < 3; ++k) attribute(c.to + k) = r[k];
        }
        void operator()(const QuotientCtx& c) const {
            attribute(c.to) = attribute(c.a) / attribute(c.b);
        }
        void operator()(const AngleCtx& c) const {
            const double d = attribute(c.a) - attribute(c.b);
            attribute(c.to) = d - std::floor(d);
        }
        void operator()(const CullCtx& c) const {
            bool kept = c.also < 0 || attribute(c.also) > 0.0;
            for (int k = 0; k < 4; ++k) {
                const double x = attribute(c.coordinate[k]);
                kept = kept && (c.less[k] != 0 ? x < 0.0 : x >= 0.0);
            }
            attribute(c.keep) = kept ? 1.0 : 0.0;
        }
        void operator()(const MagnitudeCtx& c) const {
            double f =
                static_cast<double>(c.bias) + static_cast<double>(c.scale) * plane(c.magnitude);
            if (c.clamp_factor != 0) f = clamp_to_one(f);
            for (int k = 0; k < 3; ++k) plane(c.to + k) = std::min(plane(c.from + k) * f, 1.0);
            plane(c.to + 3) = plane(c.from + 3);
        }
        double& attribute(int k) const { return to.m_attributes[static_cast<std::size_t>(k)]; }
        glm::dvec3 vector(const int (&k)[3]) const {
            return {attribute(k[0]), attribute(k[1]), attribute(k[2])};
        }
    };
    std::visit(Feed{*this}, op);
}

void ExactInputs::light(const LightingCtx& ctx) {
    const auto vector = [&](int k) {
        return glm::dvec3(attribute(k), attribute(k + 1), attribute(k + 2));
    };
    const glm::dvec3 tangent = vector(ctx.frame), bitangent = vector(ctx.frame + 3),
                     normal = vector(ctx.frame + 6), position = vector(ctx.frame + 9);
    const auto unit = [](const glm::dvec3& a) { return a / std::sqrt(glm::dot(a, a)); };
    const glm::dvec3 light(ctx.light[0], ctx.light[1], ctx.light[2]);
    const glm::dvec3 eye(ctx.eye[0], ctx.eye[1], ctx.eye[2]);
    const glm::dvec3 l = unit(light - position * static_cast<double>(ctx.light_w));
    const glm::dvec3 v = unit(eye - position);
    const auto write = [&](int k, const glm::dvec3& x) {
        if (k < 0) return;
        const double coded[3] = {glm::dot(tangent, x) * 0.5 + 0.5,
                                 glm::dot(bitangent, x) * 0.5 + 0.5,
                                 glm::dot(normal, x) * 0.5 + 0.5};
        std::copy_n(coded, 3, m_attributes.begin() + k);
    };
    write(ctx.half_vector, unit(l + v));
    write(ctx.light_vector, l);
    write(ctx.view_vector, v);
    if (ctx.n_dot_l >= 0) {
        m_attributes[static_cast<std::size_t>(ctx.n_dot_l)] = std::max(glm::dot(normal, l), 0.0);
    }
}

double ExactInputs::number(double color, Reading reading) {
    const double byte = color * 255.0;
    const double n = byte >= 127.5 ? byte - 256.0 : byte;
    switch (reading) {
        case Reading::unsigned_texel:
        case Reading::signed_texel:
            return color;
        case Reading::expanded:
            return 2.0 * std::max(color, 0.0) - 1.0;
        case Reading::two_complement:
            return n / 128.0;
        case Reading::nv2a_d3d:
            return (byte - 128.0) / 127.0;
        case Reading::nv2a_gl:
            return (n + 0.5) / 127.5;
        case Reading::nv2a_signed:
            return n / 127.0;
    }
    return color;
}

void ExactInputs::locate(const AddressCtx& ctx) {
    const double q = ctx.q < 0 ? 1.0 : attribute(ctx.q);
    m_address = ctx;
    m_u = attribute(ctx.u) / q;
    m_v = attribute(ctx.v) / q;
}

void ExactInputs::fetch(const FetchCtx& ctx) {
    const bool linear = m_address.linear != 0;
    const TexelPosition s = texel_position(m_u, m_address.width, m_address.mode_s, linear);
    const TexelPosition t = texel_position(m_v, m_address.height, m_address.mode_t, linear);
    for (int k = 0; k < ctx.count; ++k) {
        const Texture& texture = *m_shading.textures[unit_of_plane(m_shading, ctx.plane[k])];
        for (int c = 0; c < 4; ++c) {
            const auto texel = [&](int right, int down) {
                return texel_value(texture, s.texel + right, t.texel + down, c);
            };
            m_planes[static_cast<std::size_t>(ctx.plane[k] + c)] =
                mix(mix(texel(0, 0), texel(1, 0), s.weight),
                    mix(texel(0, 1), texel(1, 1), s.weight), t.weight);
        }
    }
}

std::size_t unit_of_plane(const Shading& shading, int plane) {
    const auto at = std::find_if(shading.units.begin(), shading.units.end(),
                                 [&](const PlannedUnit& u) { return u.registers == plane; });
    return static_cast<std::size_t>(at->unit);
}

}  // namespace burnish
