#include "models/brushed.hpp"

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <cmath>
#include <string>
#include <vector>

namespace burnish {
namespace {

/// Side at which the marks below have the sizes that are given for them.
constexpr double kDesignSize = 512.0;

/// Widths of the lobe along and across the marks, and how far they stray, relative.
constexpr double kAlphaAlong = 0.29;
constexpr double kAlphaAcross = 0.75;
constexpr double kAlongSpread = 0.12;
constexpr double kAcrossSpread = 0.25;

/// Integer hash with full avalanche (the finaliser of MurmurHash3, applied to a running state).
std::uint32_t mix(std::uint32_t state, std::uint32_t value) {
    std::uint32_t h = state ^ (value * 0xcc9e2d51U);
    h ^= h >> 16;
    h *= 0x85ebca6bU;
    h ^= h >> 13;
    h *= 0xc2b2ae35U;
    return h ^ (h >> 16);
}

double unit_interval(std::uint32_t h) {
    return h * (1.0 / 4294967296.0);
}

/// A sequence of numbers in [0, 1).
class Random {
  public:
    explicit Random(std::uint32_t seed) : m_seed(seed) {}
    double next() { return unit_interval(mix(m_seed, m_count++)); }
    double between(double low, double high) { return low + (high - low) * next(); }

  private:
    std::uint32_t m_seed;
    std::uint32_t m_count = 0;
};

double ease(double x) {
    return x * x * (3.0 - 2.0 * x);
}

/// Value noise in [-1, 1] on a lattice that repeats with the texture; cells are `along` texels long
/// and `across` texels wide at the design size.
class Noise {
  public:
    Noise(std::uint32_t seed, int size, double along, double across)
        : m_seed(seed), m_u(cells(size, along)), m_v(cells(size, across)), m_size(size) {}

    double at(int x, int y) const {
        const double u = (x + 0.5) * m_u / m_size;
        const double v = (y + 0.5) * m_v / m_size;
        const int row = static_cast<int>(v);
        const double top = row_at(u, static_cast<std::uint32_t>(row % m_v));
        const double bottom = row_at(u, static_cast<std::uint32_t>((row + 1) % m_v));
        return top + ease(v - row) * (bottom - top);
    }

  private:
    static int cells(int size, double texels) {
        return std::clamp(static_cast<int>(kDesignSize / texels + 0.5), 1, size);
    }
    /// Rows start at different places, lest cells line up in columns.
    double row_at(double u, std::uint32_t row) const {
        const std::uint32_t state = mix(m_seed, row);
        const double shifted = u + unit_interval(state) * m_u;
        const int cell = static_cast<int>(shifted);
        const double left = value(state, cell);
        return left + ease(shifted - cell) * (value(state, cell + 1) - left);
    }
    double value(std::uint32_t state, int cell) const {
        return 2.0 * unit_interval(mix(state, static_cast<std::uint32_t>(cell % m_u) + 1)) - 1.0;
    }

    std::uint32_t m_seed;
    int m_u;
    int m_v;
    int m_size;
};

/// Numbers per texel, rows packed, repeating in both directions.
class Field {
  public:
    explicit Field(int size)
        : m_size(size), m_values(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {}
    double& at(int x, int y) { return m_values[index(x, y)]; }
    double at(int x, int y) const { return m_values[index(x, y)]; }
    int size() const { return m_size; }

  private:
    int wrapped(int i) const { return ((i % m_size) + m_size) % m_size; }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(wrapped(y)) * static_cast<std::size_t>(m_size) +
               static_cast<std::size_t>(wrapped(x));
    }

    int m_size;
    std::vector<double> m_values;
};

/// The even grain of the brush: heights in texels, long along u.
void add_grain(Field& height, std::uint32_t seed) {
    struct Octave {
        double along, across, amplitude;
    };
    // Slopes across the marks come out near 0.1: amplitude over half a cell.
    constexpr std::array<Octave, 3> kOctaves{
        {{70.0, 2.0, 0.07}, {140.0, 5.0, 0.16}, {260.0, 14.0, 0.3}}};
    for (std::size_t k = 0; k < kOctaves.size(); ++k) {
        const Octave& octave = kOctaves[k];
        const Noise noise(mix(seed, static_cast<std::uint32_t>(k)), height.size(), octave.along,
                          octave.across);
        for (int y = 0; y < height.size(); ++y) {
            for (int x = 0; x < height.size(); ++x)
                height.at(x, y) += octave.amplitude * noise.at(x, y);
        }
    }
}

/// One groove, nearly along u, that fades at both ends.
struct Scratch {
    double x, y;        ///< start, texels
    double length;      ///< along u, texels
    double slope;       ///< rows per column
    double half_width;  ///< texels
    double depth;       ///< texels
};

void cut(Field& height, const Scratch& scratch) {
    const int steps = static_cast<int>(scratch.length);
    const int reach = static_cast<int>(scratch.half_width) + 1;
    for (int i = 0; i < steps; ++i) {
        const double middle = scratch.y + scratch.slope * i;
        const double along = (i + 0.5) / steps;
        const double depth = scratch.depth * 4.0 * along * (1.0 - along);
        const int nearest = static_cast<int>(std::floor(middle + 0.5));
        for (int row = nearest - reach; row <= nearest + reach; ++row) {
            const double d = (row - middle) / scratch.half_width;
            if (d * d >= 1.0) continue;
            const double profile = (1.0 - d * d) * (1.0 - d * d);
            height.at(static_cast<int>(scratch.x) + i, row) -= depth * profile;
        }
    }
}

/// `per_million` scratches for every million texels, up to `deepest` texels deep.
void add_scratches(Field& height, std::uint32_t seed, double per_million, double deepest) {
    Random random(seed);
    const int size = height.size();
    const double scale = size / kDesignSize;
    const int count = static_cast<int>(per_million * 1e-6 * kDesignSize * kDesignSize + 0.5);
    for (int i = 0; i < count; ++i) {
        Scratch scratch{};
        scratch.x = random.next() * size;
        scratch.y = random.next() * size;
        scratch.length = random.between(0.04, 0.40) * size;
        scratch.slope = random.between(-0.05, 0.05);
        scratch.half_width = random.between(1.2, 2.2) * std::max(scale, 0.5);
        scratch.depth = random.between(0.3, 1.0) * deepest * scale;
        cut(height, scratch);
    }
}

struct Vec3d {
    double x, y, z;
};

Vec3d normalized(const Vec3d& v) {
    const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return {v.x / length, v.y / length, v.z / length};
}

Vec3d cross(const Vec3d& a, const Vec3d& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Unit normal of the height field; y points to smaller rows.
Vec3d normal_at(const Field& height, int x, int y) {
    const double dx = 0.5 * (height.at(x + 1, y) - height.at(x - 1, y));
    const double drow = 0.5 * (height.at(x, y + 1) - height.at(x, y - 1));
    return normalized({-dx, drow, 1.0});
}

std::uint8_t signed_code(double x) {
    return static_cast<std::uint8_t>(std::clamp(std::floor(127.5 * x + 128.0), 0.0, 255.0));
}

std::uint8_t unsigned_code(double x) {
    return static_cast<std::uint8_t>(std::clamp(std::floor(255.0 * x + 0.5), 0.0, 255.0));
}

void store_vector(Image8& image, int x, int y, const Vec3d& v, double scale) {
    std::uint8_t* texel = image.at(x, y);
    texel[0] = signed_code(v.x * scale);
    texel[1] = signed_code(v.y * scale);
    texel[2] = signed_code(v.z * scale);
    texel[3] = 255;
}

/// Largest of 1, 1/2, 1/4, 1/8 that does not exceed the narrowest lobe.
float scale_for(double narrowest) {
    float scale = 1.0F;
    while (scale > 0.125F && static_cast<double>(scale) > narrowest) scale *= 0.5F;
    return scale;
}

}  // namespace

BrushedMaps brushed_maps(std::uint32_t seed, int size) {
    if (size < 1 || size > 4096)
        throw Error(ErrorCode::bad_option,
                    "brushed maps of side " + std::to_string(size) + ", expected 1 .. 4096");
    Field height(size);
    add_grain(height, mix(seed, 1));
    add_scratches(height, mix(seed, 2), 1200.0, 0.35);
    add_scratches(height, mix(seed, 3), 130.0, 1.1);

    const Noise along(mix(seed, 4), size, 128.0, 3.0);
    const Noise across(mix(seed, 5), size, 256.0, 24.0);
    const Noise shine(mix(seed, 6), size, 170.0, 2.0);
    BrushedMaps maps{Image8(size, size), Image8(size, size), Image8(size, size), Image8(size, size),
                     scale_for(kAlphaAlong * (1.0 - kAlongSpread))};
    const auto m = static_cast<double>(maps.map_scale);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const Vec3d n = normal_at(height, x, y);
            const Vec3d t = normalized({1.0 - n.x * n.x, -n.x * n.y, -n.x * n.z});
            const double alpha_x = kAlphaAlong * (1.0 + kAlongSpread * along.at(x, y));
            const double alpha_y = kAlphaAcross * (1.0 + kAcrossSpread * across.at(x, y));
            store_vector(maps.normal, x, y, n, 1.0);
            store_vector(maps.tangent, x, y, t, m / alpha_x);
            store_vector(maps.bitangent, x, y, cross(n, t), m / alpha_y);
            const double ks = 0.82 + 0.18 * shine.at(x, y);
            maps.tangent.at(x, y)[3] = unsigned_code(ks);
            std::uint8_t* specular = maps.specular.at(x, y);
            // Steel is a trace warmer than grey.
            specular[0] = unsigned_code(ks);
            specular[1] = unsigned_code(0.975 * ks);
            specular[2] = unsigned_code(0.94 * ks);
            specular[3] = unsigned_code(ks);
        }
    }
    return maps;
}

Material brushed_steel(std::uint32_t seed) {
    constexpr int kSize = 512;
    const BrushedMaps maps = brushed_maps(seed, kSize);
    const Sampler sampler;
    Material steel;
    steel.name = "brushed-steel";
    steel.kd = glm::vec3(0.26F, 0.26F, 0.27F);
    steel.ks = glm::vec3(0.95F);
    steel.alpha_x = static_cast<float>(kAlphaAlong);
    steel.alpha_y = static_cast<float>(kAlphaAcross);
    steel.normal_map = std::make_shared<const Texture>(maps.normal, sampler);
    steel.tangent_map = std::make_shared<const Texture>(maps.tangent, sampler);
    steel.bitangent_map = std::make_shared<const Texture>(maps.bitangent, sampler);
    steel.map_scale = maps.map_scale;
    steel.specular_map = std::make_shared<const Texture>(maps.specular, sampler);
    return steel;
}

std::vector<std::string_view> model_names() {
    return {"abp_modified"};
}

std::optional<Model> model_named(std::string_view name) {
    // The second is the talk's own wording.
    if (name == "abp_modified" || name == "anisotropic-blinn-phong-modified")
        return Model::abp_modified;
    return std::nullopt;
}

}  // namespace burnish
