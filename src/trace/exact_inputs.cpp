#include "trace/exact_inputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "core/dmath.hpp"
#include "trace/texel_bytes.hpp"

namespace burnish {

namespace {

/// NaN gives 0.
double clamp_to_one(double x) {
    return x > 0.0 ? std::min(x, 1.0) : 0.0;
}

/// Whether an attribute comes of texels or light, and is not where a corner, a face or a probe
/// stands.
bool is_computed(int attribute) {
    const bool of_sample = attribute >= kSampleScratch && attribute < kUnitAttributes;
    return attribute >= kMaxInterpolated && attribute != kCornerAttributes && !of_sample;
}

double mix(double a, double b, double weight) {
    return a + (b - a) * weight;
}

}  // namespace

std::vector<bool> coded_planes(const LightShading& shading, const CombinerProgram& program) {
    Registers<bool> expanded;
    const auto look = [&](const Input& in) {
        if (in.mapping < Mapping::expand || in.mapping > Mapping::half_bias_negate) return;
        std::array<bool, 4>& of = expanded[in.reg];
        if (in.component == Component::rgb) of[0] = of[1] = of[2] = true;
        if (in.component == Component::blue) of[2] = true;
        if (in.component == Component::alpha) of[3] = true;
    };
    for (const GeneralStage& stage : program.stages) {
        for (const StageFetch& fetch : stage.fetches) {
            for (int i = 0; i < coordinate_count(fetch.target); ++i) {
                const FetchCoordinate& at = fetch.coordinates[static_cast<std::size_t>(i)];
                if (at.expand) expanded[at.reg][at.component] = true;
            }
        }
        for (const Portion* p : {&stage.rgb, &stage.alpha}) {
            if (!p->writes()) continue;
            for (const Input* in : {&p->a, &p->b, &p->c, &p->d}) look(*in);
        }
    }
    std::vector<bool> coded(static_cast<std::size_t>(shading.program.plane_count));
    const auto mark = [&](int plane, bool is_coded) {
        if (plane >= 0 && is_coded) coded[static_cast<std::size_t>(plane)] = true;
    };
    for (int r = 0; r < kRegisterCount; ++r) {
        for (std::size_t c = 0; c < 4; ++c)
            mark(shading.program.input[static_cast<std::size_t>(r)][c],
                 expanded[static_cast<Register>(r)][c]);
    }
    for (const BoundFetch& fetch : shading.program.fetches) {
        for (int c = 0; c < 4; ++c)
            mark(fetch.out + c, expanded[tex(fetch.unit)][static_cast<std::size_t>(c)]);
    }
    // What goes to such a plane through others is coded there, too.
    for (auto op = shading.inputs.rbegin(); op != shading.inputs.rend(); ++op) {
        if (const auto* decode = std::get_if<DecodeCtx>(&*op)) {
            mark(decode->plane, decode->reading == Reading::expanded);
        } else if (const auto* copy = std::get_if<CopyCtx>(&*op)) {
            mark(copy->from, coded[static_cast<std::size_t>(copy->to)]);
        } else if (const auto* blend = std::get_if<BlendLevelsCtx>(&*op)) {
            for (int k = 0; k < blend->channels; ++k) {
                mark(blend->a + k, coded[static_cast<std::size_t>(blend->out + k)]);
                mark(blend->b + k, coded[static_cast<std::size_t>(blend->out + k)]);
            }
        }
    }
    return coded;
}

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

ExactInputs::Position ExactInputs::position(double u, int size, AddressMode mode, bool linear,
                                            bool rectangle) {
    const double whole = rectangle ? size : 1.0;
    double f = u;
    if (mode == AddressMode::repeat) f = u - std::floor(u);
    if (mode == AddressMode::mirrored_repeat) {
        f = u - 2.0 * std::floor(u * 0.5);
        if (f > 1.0) f = 2.0 - f;
    }
    const bool border = mode == AddressMode::clamp_to_border;
    const double low = border ? -1.0 : 0.0, high = border ? whole + 1.0 : whole;
    f = f > low ? std::min(f, high) : low;  // NaN gives `low`
    const double x = f * (rectangle ? 1.0 : size) - (linear ? 0.5 : 0.0);
    const double left = std::floor(x);
    const int texel = static_cast<int>(left);
    const double weight = linear ? x - left : 0.0;
    switch (mode) {
        case AddressMode::repeat:
            return {texel < 0 ? size - 1 : texel >= size ? 0 : texel, weight};
        case AddressMode::clamp_to_border:
            if (texel < -1) return {-1, 0.0};
            if (texel >= size) return {size, 0.0};
            return {texel, weight};
        case AddressMode::clamp_to_edge:
        case AddressMode::mirrored_repeat:
            break;
    }
    if (texel < 0) return {0, 0.0};
    return {std::min(texel, size - 1), weight};
}

void ExactInputs::locate(const AddressCtx& ctx) {
    const double q = ctx.q < 0 ? 1.0 : attribute(ctx.q);
    m_u = attribute(ctx.u) / q;
    m_v = attribute(ctx.v) / q;
    m_level = m_layer = 0;
    m_is_table = is_computed(ctx.u);
    m_is_texel = ctx.u == kCornerAttributes && is_texel(ctx.width, ctx.height);
    const bool linear = ctx.linear != 0, rectangle = ctx.rectangle != 0;
    m_column = table_position(m_u, ctx.width, ctx.mode_s, linear, rectangle);
    m_row = table_position(m_v, ctx.height, ctx.mode_t, linear, rectangle);
}

void ExactInputs::locate(const LevelAddressCtx& ctx) {
    const double q = ctx.q < 0 ? 1.0 : attribute(ctx.q);
    m_u = attribute(ctx.u) / q;
    m_v = attribute(ctx.v) / q;
    m_r = ctx.r < 0 ? 0.0 : attribute(ctx.r) / q;
    const double lod = ctx.lambda < 0 ? 0.0 : plane(ctx.lambda);
    const bool linear = (lod > 0.0 ? ctx.min_linear : ctx.mag_linear) != 0;
    const bool nearest = ctx.choice == LevelChoice::nearest;
    m_level =
        chosen_level(ctx.choice, ctx.level_count,
                     static_cast<int>(nearest ? std::ceil(256.0 * lod) : std::floor(256.0 * lod)));
    const LevelAddressCtx::Level& level = ctx.levels[m_level];
    const bool rectangle = ctx.rectangle != 0;
    m_is_table = is_computed(ctx.u);
    m_is_texel = ctx.u == kCornerAttributes && is_texel(level.width, level.height);
    m_column = table_position(m_u, level.width, ctx.mode_s, linear, rectangle);
    m_row = table_position(m_v, level.height, ctx.mode_t, linear, rectangle);
    m_layer = ctx.face < 0 ? 0 : static_cast<int>(plane(ctx.face));
    if (ctx.r < 0) return;
    const Position slice = position(m_r, level.depth, ctx.mode_r, linear, false);
    m_layer = ctx.behind != 0 ? slice_behind(slice.texel, level.depth, ctx.mode_r) : slice.texel;
    if (ctx.slice_weight >= 0) {
        m_planes[static_cast<std::size_t>(ctx.slice_weight)] = slice.weight;
    }
}

namespace {

struct CornerPlace {
    double coordinate, weight;
};

/// TexelCornerCtx along one axis, without rounding.
CornerPlace corner_place(double u, double size, double scale, AddressMode mode, bool linear,
                         bool second) {
    constexpr double kHair = 0x1p-30;
    const bool mirrored = mode == AddressMode::mirrored_repeat;
    const double whole = mode == AddressMode::repeat ? std::floor(u)
                         : mirrored                  ? 2.0 * std::floor(u * 0.5)
                                                     : 0.0;
    const double f = u - whole;
    const double g = mirrored && f > 1.0 ? 2.0 - f : f;
    const double x = g * size / scale - (linear ? 0.5 : 0.0), left = std::floor(x);
    const double c = (left + (second ? 1.5 : 0.5) + kHair) * scale / size;
    return {whole + (mirrored && f > 1.0 ? 2.0 - c : c), linear ? x - left : 0.0};
}

}  // namespace

void ExactInputs::stand_at(const TexelCornerCtx& corner) {
    const double q = corner.q < 0 ? 1.0 : attribute(corner.q);
    const double lod = corner.lambda < 0 ? 0.0 : plane(corner.lambda);
    const bool linear = (lod > 0.0 ? corner.min_linear : corner.mag_linear) != 0;
    const bool nearest = corner.choice == LevelChoice::nearest;
    const int level =
        chosen_level(corner.choice, corner.level_count,
                     static_cast<int>(nearest ? std::ceil(256.0 * lod) : std::floor(256.0 * lod)));
    const LevelAddressCtx::Level& of = corner.levels[level];
    const auto place = [&](int coordinate, int size, AddressMode mode, bool second) {
        return corner_place(attribute(coordinate) / q, size, corner.rectangle != 0 ? size : 1.0,
                            mode, linear, second);
    };
    const CornerPlace s = place(corner.u, of.width, corner.mode_s, corner.right != 0);
    const CornerPlace t = place(corner.v, of.height, corner.mode_t, corner.below != 0);
    set_attribute(corner.to, s.coordinate);
    set_attribute(corner.to + 1, t.coordinate);
    m_corner_weights = {s.weight, t.weight};
    m_corner_size = {of.width, of.height};
    if (corner.level >= 0) m_planes[static_cast<std::size_t>(corner.level)] = level;
}

namespace {

/// A number here, and its derivatives.
struct Changing {
    double value, dx, dy;
    Changing operator-() const { return {-value, -dx, -dy}; }
};

struct FacePoint {
    int face;
    Changing a, b, m;
};

FacePoint face_point(const Changing& s, const Changing& t, const Changing& r) {
    const double x = std::abs(s.value), y = std::abs(t.value), z = std::abs(r.value);
    if (x >= y && x >= z) {
        return s.value < 0.0 ? FacePoint{1, r, -t, -s} : FacePoint{0, -r, -t, s};
    }
    if (y >= z) return t.value < 0.0 ? FacePoint{3, s, -r, -t} : FacePoint{2, s, r, t};
    return r.value < 0.0 ? FacePoint{5, -s, -t, -r} : FacePoint{4, s, -t, r};
}

/// How far the coordinate c / d moves along an axis of the screen.
double moved(const Changing& c, const Changing& d, double Changing::*along) {
    return (c.*along - c.value / d.value * (d.*along)) / d.value;
}

}  // namespace

void ExactInputs::find_face(const CubeFaceCtx& ctx) {
    const auto direction = [&](int k) { return Changing{attribute(k), 0.0, 0.0}; };
    const FacePoint at = face_point(direction(ctx.s), direction(ctx.t), direction(ctx.r));
    m_attributes[static_cast<std::size_t>(ctx.u)] = at.a.value / at.m.value * 0.5 + 0.5;
    m_attributes[static_cast<std::size_t>(ctx.v)] = at.b.value / at.m.value * 0.5 + 0.5;
    m_planes[static_cast<std::size_t>(ctx.face)] = at.face;
}

/// Attributes over w are linear on the screen: differences to the neighbours are derivatives.
void ExactInputs::measure(const FootprintCtx& ctx) {
    const auto over_w = [&](int attribute) {
        const auto k = static_cast<std::size_t>(attribute + 1);
        const double here = m_over_w[0][k];
        return Changing{here, m_over_w[1][k] - here, m_over_w[2][k] - here};
    };
    Changing s = over_w(ctx.s), t = over_w(ctx.t), d = over_w(ctx.cube != 0 ? -1 : ctx.q);
    if (ctx.cube != 0) {
        const FacePoint p = face_point(s, t, over_w(ctx.r));
        s = p.a;
        t = p.b;
        d = p.m;
    }
    double largest = 0.0;
    for (double Changing::*along : {&Changing::dx, &Changing::dy}) {
        const auto texels = [&](const Changing& c, float scale) {
            return moved(c, d, along) * static_cast<double>(scale);
        };
        const double x = texels(s, ctx.scale[0]), y = texels(t, ctx.scale[1]);
        const double z = ctx.cube == 0 && ctx.r >= 0 ? texels(over_w(ctx.r), ctx.scale[2]) : 0.0;
        largest = std::max(largest, x * x + y * y + z * z);
    }
    m_attributes[static_cast<std::size_t>(ctx.out)] = largest;
}

void ExactInputs::measure(const ProbeExtentCtx& ctx) {
    const auto over_w = [&](int attribute) {
        const auto k = static_cast<std::size_t>(attribute + 1);
        const double here = m_over_w[0][k];
        return Changing{here, m_over_w[1][k] - here, m_over_w[2][k] - here};
    };
    const FootprintCtx& how = ctx.footprint;
    const Changing s = over_w(how.s), t = over_w(how.t), d = over_w(how.q);
    const auto step = [&](double Changing::*along) {
        return glm::dvec2(moved(s, d, along), moved(t, d, along));
    };
    const glm::dvec2 across = step(&Changing::dx), down = step(&Changing::dy);
    const glm::dvec2 scale(how.scale[0], how.scale[1]);
    const double x = glm::length(across * scale), y = glm::length(down * scale);
    const double longest = std::max(x, y), shortest = std::max(std::min(x, y), 1.0);
    const double n =
        std::clamp(std::ceil(longest / shortest - 0x1p-8), 1.0, static_cast<double>(ctx.most));
    const glm::dvec2 apart = n > 1.0 ? (x > y ? across : down) / (n + 1.0) : glm::dvec2(0.0);
    set_attribute(how.out, longest * longest / (n * n));
    set_attribute(ctx.probes, n);
    set_attribute(ctx.step, apart.x);
    set_attribute(ctx.step + 1, apart.y);
}

ExactInputs::Position ExactInputs::table_position(double u, int size, AddressMode mode, bool linear,
                                                  bool rectangle) {
    const Position exact = position(u, size, mode, linear, rectangle);
    if (!m_is_table || m_rounding.quantiser == nullptr || size < 2) return exact;
    const double last = size - 1;
    const double at = std::clamp((exact.texel + exact.weight) / last, 0.0, 1.0);
    const double x = last * m_rounding.quantiser->unsigned_number(at, m_rounding.table);
    if (m_rounding.table == kExactBits) return exact;
    const double left = std::min(std::floor(x), last - 1.0);
    return {static_cast<int>(left), x - left};
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

namespace {

/// A coordinate of a table as a texture's.
double table_coordinate(const LookUpTableCtx::Axis& axis, double at) {
    const double scaled = at * static_cast<double>(axis.scale) + static_cast<double>(axis.offset);
    return scaled / static_cast<double>(axis.divisor);
}

}  // namespace

ExactInputs::Position ExactInputs::position_along(const LookUpTableCtx::Axis& axis, double at) {
    if (axis.plane < 0) return {};
    return table_position(table_coordinate(axis, at), axis.size, AddressMode::clamp_to_edge, true,
                          false);
}

int ExactInputs::table_values() const {
    const bool given = m_rounding.grid != nullptr && m_rounding.grid->values != kExactBits;
    return given ? m_rounding.grid->values : m_rounding.table;
}

ExactInputs::GridPlace ExactInputs::grid_place(const LookUpTableCtx& ctx, std::size_t axis,
                                               double at) {
    const LookUpTableCtx::Axis& of = axis == 0 ? ctx.s : ctx.t;
    if (of.plane < 0) return {};
    const TableGrid& grid = *m_rounding.grid;
    const auto table = std::find_if(grid.tables.begin(), grid.tables.end(),
                                    [&](const auto& each) { return each.texels == ctx.texels; });
    const TableGrid::Table known = table == grid.tables.end() ? TableGrid::Table{} : *table;
    const SpacedAxis spaced(grid.spacing, known.first.at(axis), known.last.at(axis));
    const Position exact =
        position(table_coordinate(of, at), of.size, AddressMode::clamp_to_edge, true, false);
    const double last = of.size - 1;
    const auto place = [&](double coordinate) {
        const double x = last * spaced.position(coordinate);
        const double left = std::clamp(std::floor(x), 0.0, std::max(last - 1.0, 0.0));
        return Position{static_cast<int>(left), x - left};
    };
    if (of.size < 2) return {exact, exact, 0.0};
    double coordinate =
        spaced.coordinate(std::clamp((exact.texel + exact.weight) / last, 0.0, 1.0));
    Quantiser& quantiser = *m_rounding.quantiser;
    coordinate = quantiser.unsigned_number(coordinate, grid.index);
    if (m_rounding.table == kExactBits || !grid.linear) {
        const Position only = place(quantiser.unsigned_number(coordinate, m_rounding.table));
        return {only, only, 0.0};
    }
    const double steps = std::ldexp(1.0, m_rounding.table) - 1.0;
    const double below = std::min(std::floor(coordinate * steps), steps - 1.0);
    return {place(below / steps), place((below + 1.0) / steps), coordinate * steps - below};
}

void ExactInputs::look_up(const LookUpTableCtx& ctx, double s, double t) {
    m_is_table = true;
    m_is_texel = false;
    m_level = m_layer = 0;
    const Texture& texture = texture_at(m_shading, ctx.texels);
    const auto fetch_all = [&](const auto& use) {
        for (const int out : ctx.out) {
            if (out < 0) continue;
            fetch(texture, out, 1);
            use(m_planes[static_cast<std::size_t>(out)]);
        }
    };
    if (m_rounding.grid == nullptr || m_rounding.quantiser == nullptr) {
        m_column = position_along(ctx.s, s);
        m_row = position_along(ctx.t, t);
        fetch_all([](double&) {});
        return;
    }
    const GridPlace column = grid_place(ctx, 0, s), row = grid_place(ctx, 1, t);
    // Every channel has the same texels.
    std::array<double, 4> corners{};
    for (std::size_t k = 0; k < 4; ++k) {
        m_column = k % 2 == 0 ? column.low : column.high;
        m_row = k < 2 ? row.low : row.high;
        fetch_all([&](double& value) { corners.at(k) = value; });
    }
    const double value = mix(mix(corners[0], corners[1], column.weight),
                             mix(corners[2], corners[3], column.weight), row.weight);
    for (const int out : ctx.out)
        if (out >= 0)
            m_planes[static_cast<std::size_t>(out)] =
                rounded(value, out, texture.is_signed(0), table_values());
}

void ExactInputs::average(const AverageTableCtx& ctx, double s, double t, double half) {
    const auto texels = [&](double at) { return table_coordinate(ctx.s, at) * ctx.s.size - 0.5; };
    const Texture& table = texture_at(m_shading, ctx.texels);
    double low = texels(std::max(s - half, static_cast<double>(ctx.least)));
    double high = texels(std::min(s + half, static_cast<double>(ctx.most)));
    if (!(low < high)) low = high = texels(s);
    m_is_table = true;
    m_row = position_along(ctx.t, t);
    const double mean = mix(mean_of_row(table, m_row.texel, low, high),
                            mean_of_row(table, m_row.texel + 1, low, high), m_row.weight);
    for (const int out : ctx.out)
        if (out >= 0) m_planes[static_cast<std::size_t>(out)] = mean;
}

double ExactInputs::mean_of_row(const Texture& table, int row, double low, double high) {
    const double last = table.width() - 1;
    const auto value = [&](double at) {
        const double inside = std::clamp(at, 0.0, last);
        const auto left = static_cast<int>(inside);
        const auto texel = [&](int x) {
            return texel_value(table, 0, 0, std::min(x, table.width() - 1), row, 0);
        };
        return mix(texel(left), texel(left + 1), inside - left);
    };
    if (!(low < high)) return value(low);
    double sum = 0.0;
    for (double from = low, to = low; from < high; from = to) {
        to = std::min(std::floor(from) + 1.0, high);
        sum += 0.5 * (value(from) + value(to)) * (to - from);
    }
    return sum / (high - low);
}

int any_output(std::span<const int, 4> out) {
    return *std::find_if(out.begin(), out.end(), [](int plane) { return plane >= 0; });
}

const Texture& texture_at(const Shading& shading, const std::uint8_t* texels) {
    return **std::find_if(shading.textures.begin(), shading.textures.end(),
                          [&](const TexturePtr& t) { return t && t->texels() == texels; });
}

int chosen_level(LevelChoice choice, int level_count, int lod) {
    const int last = level_count - 1;
    switch (choice) {
        case LevelChoice::base:
            break;
        case LevelChoice::nearest:
            return std::min((lod + 127) >> 8, last);
        case LevelChoice::floor:
            return lod >> 8;
        case LevelChoice::ceiling:
            return std::min((lod >> 8) + 1, last);
    }
    return 0;
}

int slice_behind(int at, int depth, AddressMode mode) {
    if (mode == AddressMode::clamp_to_border) return std::min(at + 1, depth);
    if (mode == AddressMode::repeat) return (at + 1) % depth;
    return std::min(at + 1, depth - 1);
}

}  // namespace burnish
