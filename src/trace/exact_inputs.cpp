#include "trace/exact_inputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "core/dmath.hpp"
#include "trace/mix.hpp"
#include "trace/texel_bytes.hpp"

namespace burnish {

namespace {

/// NaN gives 0.
double clamp_to_one(double x) {
    return x > 0.0 ? std::min(x, 1.0) : 0.0;
}

}  // namespace

ExactInputs::ExactInputs(const Shading& shading, const ScreenMesh& mesh,
                         const SetupTriangle& triangle, std::int32_t x, std::int32_t y,
                         const InputRounding& rounding)
    : m_shading(shading),
      m_rounding(rounding),
      m_attributes(kMaxAttributes),
      m_planes(static_cast<std::size_t>(shading.program.plane_count)) {
    CornerAttributes corner;
    corner_attributes(shading, mesh, triangle, corner);
    const auto count = static_cast<std::size_t>(shading.interpolated());
    const std::array<Barycentrics, 3> places{barycentrics(mesh, triangle, x, y),
                                             barycentrics(mesh, triangle, x + 1, y),
                                             barycentrics(mesh, triangle, x, y + 1)};
    for (std::size_t p = 0; p < 3; ++p) {
        m_over_w[p] = {places[p].one_over_w};
        for (std::size_t k = 0; k < count; ++k) {
            double value = 0.0;
            for (std::size_t i = 0; i < 3; ++i) {
                value += places[p].weight[i] * static_cast<double>(corner[i][k]);
            }
            if (p == 0) m_attributes[k] = value;
            m_over_w[p].push_back(value * places[p].one_over_w);
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
            plane(c.plane) = to.rounded(clamp_to_one(attribute(c.attribute)), c.plane, false,
                                        to.m_rounding.vectors);
        }
        void operator()(const AddressCtx& c) const { to.locate(c); }
        void operator()(const FetchCtx& c) const {
            for (int k = 0; k < c.count; ++k) {
                to.fetch(texture_at(to.m_shading, c.texels[k]), c.plane[k], 4);
            }
        }
        void operator()(const CubeFaceCtx& c) const { to.find_face(c); }
        void operator()(const PlaneFootprintCtx& c) const { to.measure(c.footprint); }
        void operator()(const QuadFootprintCtx& /*c*/) const {}  // the caller's
        void operator()(const LevelOfDetailCtx& c) const {
            const double squared = std::clamp(to.attribute(c.footprint), 0x1p-64, 0x1p64);
            const double lod = 0.5 * dmath::log2(squared) + c.bias / 256.0;
            plane(c.plane) = std::clamp(lod, 0.0, c.max / 256.0);
        }
        void operator()(const LevelAddressCtx& c) const { to.locate(c); }
        void operator()(const FetchHiloCtx& c) const {
            to.fetch(texture_at(to.m_shading, c.texels), c.plane, 2);
        }
        void operator()(const FetchWordsCtx& c) const {
            to.fetch(texture_at(to.m_shading, c.texels), c.plane, 4);
        }
        void operator()(const FetchQuartetCtx& c) const {
            for (int k = 0; k < FetchQuartetCtx::kTextures; ++k) {
                if (c.plane[k] < 0) continue;
                const std::uint8_t* const texels = c.texels + FetchQuartetCtx::kNextTexture * k;
                to.fetch(texture_at(to.m_shading, texels), c.plane[k], 4);
            }
        }
        void operator()(const LookUpTableCtx& c) const {
            to.look_up(c, plane(c.s.plane), c.t.plane < 0 ? 0.0 : plane(c.t.plane));
        }
        void operator()(const AverageTableCtx& /*c*/) const {}  // between stages alone
        void operator()(const BlendLevelsCtx& c) const {
            const double weight = to.cut(plane(c.weight) - std::floor(plane(c.weight)));
            for (int k = 0; k < c.channels; ++k) {
                plane(c.out + k) = to.rounded(mix(plane(c.a + k), plane(c.b + k), weight),
                                              c.out + k, false, to.m_rounding.filter);
            }
        }
        void operator()(const ProbeExtentCtx& c) const { to.measure(c); }
        void operator()(const ProbedCtx& /*c*/) const {}   // the caller's
        void operator()(const BlendedCtx& /*c*/) const {}  // a fragment alone goes through all
        void operator()(const PrefetchQuartetCtx& /*c*/) const {}  // of whole packets
        void operator()(const HiloCtx& c) const {
            for (int k = 0; k < 2; ++k) {
                to.m_attributes[static_cast<std::size_t>(c.out + k)] = plane(c.plane + k);
            }
        }
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

void ExactInputs::feed_all(std::span<const InputOp> ops) {
    for (std::size_t i = 0; i < ops.size(); ++i) {
        if (const auto* probed = std::get_if<ProbedCtx>(&ops[i])) {
            const auto count = static_cast<std::size_t>(probed->count);
            feed_probes(*probed, ops.subspan(i + 1, count));
            i += count;
        } else {
            feed(ops[i]);
        }
    }
}

void ExactInputs::feed_probes(const ProbedCtx& probed, std::span<const InputOp> ops) {
    const ProbePointCtx& point = probed.point;
    const int probes = static_cast<int>(attribute(point.probes));
    const double q = point.q < 0 ? 1.0 : attribute(point.q);
    const glm::dvec2 pixel = glm::dvec2(attribute(point.u), attribute(point.v)) / q;
    const glm::dvec2 step(attribute(point.step), attribute(point.step + 1));
    std::array<double, ProbeSumCtx::kMaxChannels> sums{};
    const auto channels = static_cast<std::size_t>(probed.sum.channels);
    for (int k = 0; k < probes; ++k) {
        const glm::dvec2 at = pixel + step * (k - 0.5 * (probes - 1));
        set_attribute(point.to, at.x);
        set_attribute(point.to + 1, at.y);
        feed_all(ops);
        for (std::size_t c = 0; c < channels; ++c) sums.at(c) += plane(probed.sum.plane[c]);
    }
    if (probes == 1) return;
    for (std::size_t c = 0; c < channels; ++c) {
        const int to = probed.sum.plane[c];
        m_planes[static_cast<std::size_t>(to)] =
            rounded(sums.at(c) / probes, to, false, m_rounding.filter);
    }
}

void ExactInputs::light(const LightingCtx& ctx) {
    const auto vector = [&](int k) {
        return glm::dvec3(attribute(k), attribute(k + 1), attribute(k + 2));
    };
    glm::dvec3 tangent = vector(ctx.frame), bitangent = vector(ctx.frame + 3),
               normal = vector(ctx.frame + 6);
    const glm::dvec3 position = vector(ctx.frame + 9);
    const auto unit = [](const glm::dvec3& a) { return a / std::sqrt(glm::dot(a, a)); };
    if (ctx.orthonormal != 0) {
        normal = unit(normal);
        tangent = unit(tangent - normal * glm::dot(normal, tangent));
        const glm::dvec3 c = glm::cross(normal, tangent);
        bitangent = glm::dot(c, bitangent) < 0.0 ? -c : c;
    }
    const glm::dvec3 light(ctx.light[0], ctx.light[1], ctx.light[2]);
    const glm::dvec3 eye(ctx.eye[0], ctx.eye[1], ctx.eye[2]);
    const glm::dvec3 l = unit(light - position * static_cast<double>(ctx.light_w));
    const glm::dvec3 v = unit(eye - position * static_cast<double>(ctx.eye_w));
    const auto write = [&](int k, const glm::dvec3& x) {
        if (k < 0) return;
        const double coded[3] = {glm::dot(tangent, x) * 0.5 + 0.5,
                                 glm::dot(bitangent, x) * 0.5 + 0.5,
                                 glm::dot(normal, x) * 0.5 + 0.5};
        std::copy_n(coded, 3, m_attributes.begin() + k);
    };
    const glm::dvec3 h = ctx.raw_half != 0 ? (l + v) * 0.5 : unit(l + v);
    write(ctx.half_vector, h);
    write(ctx.light_vector, l);
    write(ctx.view_vector, v);
    if (ctx.n_dot_l >= 0) {
        m_attributes[static_cast<std::size_t>(ctx.n_dot_l)] = std::max(glm::dot(normal, l), 0.0);
    }
    if (ctx.h_dot_l >= 0) {
        m_attributes[static_cast<std::size_t>(ctx.h_dot_l)] = std::max(glm::dot(h, l), 0.0);
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

double ExactInputs::cut(double weight) const {
    if (m_rounding.filter == kExactBits) return weight;
    const double one = std::ldexp(1.0, m_rounding.filter);
    return std::floor(weight * one) / one;
}

double ExactInputs::rounded(double x, int plane, bool is_signed, int bits) {
    if (m_rounding.quantiser == nullptr) return x;
    if (is_signed) return m_rounding.quantiser->signed_number(x, bits);
    if (m_rounding.coded != nullptr && (*m_rounding.coded)[static_cast<std::size_t>(plane)])
        return m_rounding.quantiser->coded_number(x, bits);
    return m_rounding.quantiser->unsigned_number(x, bits);
}

void ExactInputs::fetch(const Texture& texture, int plane, int channels) {
    const bool given = &texture == m_shading.half_cube.get();
    const InputRounding kept = m_rounding;
    if (given) m_rounding = {};
    for (int c = 0; c < channels; ++c) {
        const int to = plane + c;
        const bool is_signed = texture.is_signed(c);
        const auto texel = [&](int right, int down) {
            return rounded(texel_value(texture, m_level, m_layer, m_column.texel + right,
                                       m_row.texel + down, c),
                           to, is_signed, m_is_table ? kExactBits : m_rounding.texels);
        };
        const auto lerp = [&](double a, double b, double weight) {
            if (m_is_table || m_is_texel) return mix(a, b, weight);
            return rounded(mix(a, b, cut(weight)), to, is_signed, m_rounding.filter);
        };
        const double upper = lerp(texel(0, 0), texel(1, 0), m_column.weight);
        const double lower = lerp(texel(0, 1), texel(1, 1), m_column.weight);
        const double value = lerp(upper, lower, m_row.weight);
        m_planes[static_cast<std::size_t>(to)] =
            rounded(value, to, is_signed, m_is_table ? table_values() : kExactBits);
    }
    m_rounding = kept;
}

RealRegisters ExactInputs::registers() const {
    RealRegisters result;
    const auto take = [&](Register reg) {
        for (std::size_t c = 0; c < 4; ++c) {
            const int k = m_shading.program.input[static_cast<std::size_t>(reg)][c];
            if (k >= 0) result[reg][c] = plane(k);
        }
    };
    take(Register::col0);
    take(Register::col1);
    for (int unit = 0; unit < 16; ++unit) {
        if ((m_shading.unit_states.black >> unit & 1) != 0) continue;
        if ((m_shading.unit_states.enabled >> unit & 1) != 0) {
            take(tex(unit));
        } else {
            result[tex(unit)][3] = 1.0;
        }
    }
    return result;
}

Reals ExactInputs::fetch_between_stages(std::size_t number, const std::array<double, 3>& at,
                                        double footprint) {
    const BoundFetch& bound = m_shading.program.fetches.at(number);
    Reals reals{};
    std::size_t coordinate = 0;
    for (const InputOp& op : m_shading.stage_fetches.at(number).ops) {
        if (const auto* decode = std::get_if<DecodeCtx>(&op)) {
            set_attribute(decode->attribute, at.at(coordinate++));
        } else if (const auto* quad = std::get_if<QuadFootprintCtx>(&op)) {
            set_attribute(quad->footprint.out, footprint);
        } else if (const auto* table = std::get_if<LookUpTableCtx>(&op)) {
            look_up(*table, at[0], at[1]);
            reals.fill(plane(any_output(table->out)));
            return reals;
        } else if (const auto* sums = std::get_if<AverageTableCtx>(&op)) {
            average(*sums, at[0], at[1], footprint);
            reals.fill(plane(any_output(sums->out)));
            return reals;
        } else {
            feed(op);
        }
    }
    for (std::size_t c = 0; c < 4; ++c) reals[c] = plane(bound.out + static_cast<int>(c));
    return reals;
}

const Texture& texture_at(const Shading& shading, const std::uint8_t* texels) {
    return **std::find_if(shading.textures.begin(), shading.textures.end(),
                          [&](const TexturePtr& t) { return t && t->texels() == texels; });
}

}  // namespace burnish
