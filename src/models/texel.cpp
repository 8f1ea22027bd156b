#include "models/texel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <cmath>
#include <utility>

#include "core/tile_watch.hpp"
#include "models/map_sampler.hpp"
#include "models/mips/parameter_mips.hpp"
#include "models/srgb.hpp"
#include "models/vector_encoding.hpp"

namespace burnish {
namespace {

std::array<std::pair<const char*, TexturePtr>, 9> maps_of(const Material& m) {
    return {{{"normal_map", m.normal_map},
             {"tangent_map", m.tangent_map},
             {"bitangent_map", m.bitangent_map},
             {"direction_map", m.direction_map},
             {"alpha_x", m.alpha_x_map.texture},
             {"alpha_y", m.alpha_y_map.texture},
             {"exponent", m.exponent_map.texture},
             {"kd_map", m.kd_map},
             {"specular_map", m.specular_map}}};
}

/// Channel c of the texel (x, y) as the number of its format, 0 .. 1 or -1 .. 1; (-1, -1): of the
/// border. Formats of two channels have b = 0 and a = 1.
double channel(const Texture& map, std::size_t level, int x, int y, int c) {
    if (x < 0) return static_cast<double>(map.sampler().border[static_cast<std::size_t>(c)]);
    if (is_hilo(map.format()) && c > 1) return c == 3 ? 1.0 : 0.0;
    const bool words = has_words(map.format());
    const double most = map.is_signed(c) ? (words ? 32768.0 : 128.0) : (words ? 65535.0 : 255.0);
    return map.texel(level, 0, x, y, c) / most;
}

/// Component c of a vector; formats that are signed already are decoded by their own rule.
double component(const Texture& map, std::size_t level, VectorEncoding encoding, int x, int y,
                 int c) {
    if (x < 0 || map.is_signed(c)) return channel(map, level, x, y, c);
    return decode_vector_code(encoding, map.texel(level, 0, x, y, c),
                              has_words(map.format()) ? 16 : 8);
}

/// The level of a map that stands beside a material's: its last one, if it has fewer.
std::size_t level_of(const Texture& map, int level) {
    return std::min(static_cast<std::size_t>(level), map.levels().size() - 1);
}

/// `filter` for a material with these mip levels: one that blends them if it knew none.
Filter with_levels(Filter filter, const MaterialMipmaps& mipmaps) {
    const bool linear = is_linear_within(filter);
    if (mipmaps.method == MipMethod::none) return linear ? Filter::linear : Filter::nearest;
    if (filter == Filter::linear) return Filter::linear_mipmap_linear;
    if (filter == Filter::nearest) return Filter::nearest_mipmap_linear;
    return filter;
}

}  // namespace

glm::dvec3 perpendicular(const glm::dvec3& v, const glm::dvec3& n) {
    const double along = glm::dot(v, n);
    const glm::dvec3 rest = v - n * along;
    const double length = std::sqrt(glm::dot(rest, rest));
    if (length > 1e-6) return rest / length;
    const glm::dvec3 down(0.0, 0.0, along < 0.0 ? 1.0 : -1.0);
    const glm::dvec3 fallback = down - n * glm::dot(down, n);
    const double left = std::sqrt(glm::dot(fallback, fallback));
    return left > 1e-6 ? fallback / left : glm::dvec3(1.0, 0.0, 0.0);
}

TexelSource::TexelSource(const Material& material, std::function<bool()> stop)
    : m_material(material), m_stop(std::move(stop)) {
    if (!material.tangent_map != !material.bitangent_map)
        throw Error(ErrorCode::bad_program,
                    fmt::format("material '{}': one of tangent_map and bitangent_map, expected "
                                "both or neither",
                                material.name));
    if (material.tangent_map && !(material.map_scale > 0.0F))
        throw Error(ErrorCode::bad_program,
                    fmt::format("material '{}': map_scale {} of its vector maps, expected more "
                                "than 0",
                                material.name, material.map_scale));
    for (const ParameterMap* map :
         {&material.alpha_x_map, &material.alpha_y_map, &material.exponent_map}) {
        if (map->channel < 0 || map->channel > 3)
            throw Error(ErrorCode::bad_program,
                        fmt::format("material '{}': channel {} of a map, expected 0 .. 3",
                                    material.name, map->channel));
    }
    std::int64_t most = 0;
    for (const auto& [name, map] : maps_of(material)) {
        if (!map) continue;
        if (map->target() != TextureTarget::two_d)
            throw Error(
                ErrorCode::bad_program,
                fmt::format("material '{}': {} is not two-dimensional", material.name, name));
        m_varies = true;
        m_averages_layer |= map->levels().size() > 1 && !material.mipmaps;
        const std::int64_t texels = static_cast<std::int64_t>(map->width()) * map->height();
        if (texels <= most) continue;
        most = texels;
        m_width = map->width();
        m_height = map->height();
        m_sampler = map->sampler();
        m_map_levels.assign(map->levels().begin(), map->levels().end());
    }
    make_mips();
}

void TexelSource::make_mips() {
    std::vector<mips::ParameterGrid> mips;
    if (m_material.mipmaps) {
        m_sampler.filter = with_levels(m_sampler.filter, *m_material.mipmaps);
        m_sampler.max_anisotropy =
            std::max(m_sampler.max_anisotropy, m_material.mipmaps->max_anisotropy);
        if (m_material.mipmaps->method == MipMethod::maps) {
            mips = mips_of_maps();
        } else {
            mips =
                mips::parameter_mips([this](int x, int y) { return at(x, y); }, m_width, m_height,
                                     mips::LobeShape(m_material), *m_material.mipmaps, m_stop);
        }
    }
    m_mips = std::make_shared<const std::vector<mips::ParameterGrid>>(std::move(mips));
}

std::vector<mips::ParameterGrid> TexelSource::mips_of_maps() const {
    std::vector<mips::ParameterGrid> mips;
    mips::require_room(m_width, m_height);
    for (std::size_t k = 1; k < m_map_levels.size(); ++k) {
        const MapLevel level{static_cast<int>(k), m_map_levels[k].width, m_map_levels[k].height};
        mips::ParameterGrid& grid = mips.emplace_back();
        grid.width = level.width;
        grid.height = level.height;
        for (int y = 0; y < level.height; ++y) {
            require_wanted();
            for (int x = 0; x < level.width; ++x) grid.texels.push_back(read(level, x, y));
        }
    }
    return mips;
}

void TexelSource::require_wanted() const {
    burnish::require_wanted(m_stop);
}

int TexelSource::levels() const {
    return 1 + static_cast<int>(m_mips->size());
}

int TexelSource::width(int level) const {
    return level == 0 ? m_width : (*m_mips)[static_cast<std::size_t>(level) - 1].width;
}

int TexelSource::height(int level) const {
    return level == 0 ? m_height : (*m_mips)[static_cast<std::size_t>(level) - 1].height;
}

TexelParameters TexelSource::at(int level, int x, int y) const {
    return level == 0 ? at(x, y) : (*m_mips)[static_cast<std::size_t>(level) - 1].at(x, y);
}

double TexelSource::parameter(const ParameterMap& map, float constant, const MapLevel& in, int x,
                              int y) const {
    if (!map.texture) return static_cast<double>(constant);
    const Texture& texture = *map.texture;
    const std::size_t level = level_of(texture, in.level);
    const double value =
        MapSampler(texture, level, in.width, in.height).at(x, y, [&](int i, int j) {
            return channel(texture, level, i, j, map.channel);
        });
    const auto low = static_cast<double>(map.low);
    return low + (static_cast<double>(map.high) - low) * value;
}

glm::dvec3 TexelSource::color(const TexturePtr& map, const glm::vec3& factor, const MapLevel& in,
                              int x, int y) const {
    if (!map) return {factor};
    const std::size_t level = level_of(*map, in.level);
    const auto texel = [&](int i, int j) {
        glm::dvec3 c;
        for (int k = 0; k < 3; ++k) {
            const double value = channel(*map, level, i, j, k);
            c[k] = m_material.srgb_colors ? linear_from_srgb(value) : value;
        }
        return c;
    };
    const glm::dvec3 c = MapSampler(*map, level, in.width, in.height).at(x, y, texel);
    return glm::max(c * glm::dvec3(factor), glm::dvec3(0.0));
}

glm::dvec3 TexelSource::vector(const TexturePtr& map, VectorEncoding encoding, const MapLevel& in,
                               int x, int y) const {
    const std::size_t level = level_of(*map, in.level);
    return MapSampler(*map, level, in.width, in.height).at(x, y, [&](int i, int j) {
        const double r = component(*map, level, encoding, i, j, 0);
        const double g = component(*map, level, encoding, i, j, 1);
        // Formats of two channels leave the third to the length.
        const double b = is_hilo(map->format()) ? std::sqrt(std::max(1.0 - r * r - g * g, 0.0))
                                                : component(*map, level, encoding, i, j, 2);
        return glm::dvec3(r, g, b);
    });
}

glm::dvec3 TexelSource::normal(const MapLevel& in, int x, int y) const {
    glm::dvec3 n = vector(m_material.normal_map, m_material.encoding, in, x, y);
    if (!m_material.normal_y_up) n.y = -n.y;
    const double length = std::sqrt(glm::dot(n, n));
    return length > 1e-6 ? n / length : glm::dvec3(0.0, 0.0, 1.0);
}

TexelParameters TexelSource::at(int x, int y) const {
    return read({0, m_width, m_height}, x, y);
}

TexelParameters TexelSource::read(const MapLevel& in, int x, int y) const {
    TexelParameters p;
    const Material& m = m_material;
    if (m.normal_map) p.n = normal(in, x, y);
    p.alpha_x = parameter(m.alpha_x_map, m.alpha_x, in, x, y);
    p.alpha_y = parameter(m.alpha_y_map, m.alpha_y, in, x, y);
    glm::dvec3 t(1.0, 0.0, 0.0);
    if (m.tangent_map) {
        // The machine reads these two with expand, whatever the others are coded in.
        t = vector(m.tangent_map, VectorEncoding::d, in, x, y);
        const glm::dvec3 b = vector(m.bitangent_map, VectorEncoding::d, in, x, y);
        const auto scale = static_cast<double>(m.map_scale);
        p.alpha_x = scale / std::max(std::sqrt(glm::dot(t, t)), scale);
        p.alpha_y = scale / std::max(std::sqrt(glm::dot(b, b)), scale);
        const glm::dvec3 n = glm::cross(t, b);
        const double length = std::sqrt(glm::dot(n, n));
        if (!m.normal_map && length > 1e-6) p.n = n / length;
    } else if (m.direction_map) {
        const glm::dvec3 direction = vector(m.direction_map, m.encoding, in, x, y);
        const double length = std::sqrt(direction.x * direction.x + direction.y * direction.y);
        if (length > 1e-6) t = glm::dvec3(direction.x / length, direction.y / length, 0.0);
    }
    p.t = perpendicular(t, p.n);
    p.b = glm::cross(p.n, p.t);
    p.alpha_x = std::clamp(p.alpha_x, kLeastAlpha, kMostAlpha);
    p.alpha_y = std::clamp(p.alpha_y, kLeastAlpha, kMostAlpha);
    p.exponent = std::max(parameter(m.exponent_map, m.exponent, in, x, y), 0.0);
    p.kd = color(m.kd_map, m.kd, in, x, y);
    p.ks = color(m.specular_map, m.ks, in, x, y);
    return p;
}

}  // namespace burnish
