#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "trace/exact_inputs.hpp"

/// Where ExactInputs reads a texture: faces, footprints, levels, texels and weights.
namespace burnish {

namespace {

/// Whether an attribute comes of texels or light, and is not where a corner, a face or a probe
/// stands.
bool is_computed(int attribute) {
    const bool of_sample = attribute >= kSampleScratch && attribute < kUnitAttributes;
    return attribute >= kMaxInterpolated && attribute != kCornerAttributes && !of_sample;
}

}  // namespace

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
