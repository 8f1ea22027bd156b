#include "models/bake.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/dmath.hpp"

namespace burnish {

namespace {

constexpr int kWideOne = 16384;

/// A number of 0 .. 1 as a texel's word, whose code in a wide register is as near as can be, or as
/// near as words are, or as a byte.
int texel_code(double x, TexelCoding coding) {
    x = std::clamp(x, 0.0, 1.0);
    if (coding == TexelCoding::bytes) return static_cast<int>(255.0 * x + 0.5);
    if (coding == TexelCoding::fine) return static_cast<int>(65535.0 * x + 0.5);
    return std::min(4 * static_cast<int>(kWideOne * x + 0.5), 65535);
}

/// A component of -1 .. 1, for `expand`.
int vector_code(double x, TexelCoding coding) {
    if (coding != TexelCoding::bytes) return texel_code(0.5 * x + 0.5, coding);
    return static_cast<int>(std::clamp(127.5 * x + 128.0, 0.0, 255.0));
}

/// Channels of a texture and its levels, whichever texels it has.
class TexelImage {
  public:
    explicit TexelImage(TexelCoding coding) : m_is_words(coding != TexelCoding::bytes) {}

    void add_level(int width, int height) {
        if (m_is_words) {
            m_words.emplace_back(width, height);
        } else {
            m_bytes.emplace_back(width, height);
        }
    }
    /// In the last level.
    void put(int x, int y, int channel, int code) {
        if (m_is_words) {
            m_words.back().at(x, y)[channel] = static_cast<std::uint16_t>(code);
        } else {
            m_bytes.back().at(x, y)[channel] = static_cast<std::uint8_t>(code);
        }
    }
    TexturePtr texture(const TextureDescription& of) const {
        TextureDescription description = of;
        if (m_is_words) {
            description.format = TexelFormat::rgba16;
            return std::make_shared<const Texture>(std::span(m_words), description);
        }
        return std::make_shared<const Texture>(std::span(m_bytes), description);
    }

  private:
    bool m_is_words;
    std::vector<Image8> m_bytes;
    std::vector<Image16> m_words;
};

TexturePtr table_texture(const PlanTable& table, TexelCoding coding, const Machine& machine) {
    const int width = table.axes[0].size;
    const int height = table.axes.size() == 2 ? table.axes[1].size : 1;
    TexelImage image(coding);
    image.add_level(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double value = table.values[static_cast<std::size_t>(y * width + x)];
            const int code = table.coded ? vector_code(value, coding) : texel_code(value, coding);
            for (int c = 0; c < 4; ++c) image.put(x, y, c, code);
        }
    }
    const bool is_words = coding != TexelCoding::bytes;
    Sampler sampler;
    // A nine-bit coordinate has a texel of its own.
    sampler.filter = is_words ? Filter::linear : Filter::nearest;
    const bool has_levels = machine.table_filter == TableFilter::mip;
    if (has_levels) {
        sampler.mag_filter = sampler.filter;
        sampler.filter = Filter::linear_mipmap_linear;
    }
    if (machine.table_filter != TableFilter::point) sampler.lod_bias = machine.table_bias;
    sampler.wrap_s = sampler.wrap_t = Wrap::clamp_to_edge;
    const auto span = [&](std::size_t axis) {
        return table.axes[axis].is_signed ? TexelSpan::signed_centers : TexelSpan::centers;
    };
    sampler.span_s = span(0);
    if (height > 1) sampler.span_t = span(1);
    TexturePtr texture =
        image.texture({.target = height == 1 ? TextureTarget::one_d : TextureTarget::two_d,
                       .sampler = sampler,
                       .box_mipmaps = has_levels});
    if (!is_words || has_levels) return texture;
    if (machine.table_filter == TableFilter::exact && !table.axes[0].of_material)
        return Texture::summed_table(*texture, table.axes[0].range);
    return Texture::table(*texture);
}

/// How the codes of a quantity are read.
LayerQuantity description(const PlanQuantity& q, TexelCoding coding) {
    LayerQuantity d;
    d.name = q.name;
    d.components = q.kind == ValueKind::scalar ? 1 : 3;
    d.logarithmic = q.logarithmic;
    // Registers hold n / 65536, n / 255, and twice that less 1, less 256/255.
    const double one = coding == TexelCoding::words ? 65535.0 / 65536.0 : 1.0;
    if (q.is_coded()) {
        d.scale = q.unit * (2.0 * one);
        d.offset = q.unit * (coding == TexelCoding::bytes ? -256.0 / 255.0 : -1.0);
    } else {
        d.scale = q.unit * one;
        d.offset = glm::dvec3(q.low);
    }
    return d;
}

/// Component `c` of a quantity as codes, from left to right.
template <class Put>
void write_row(const PlanQuantity& q, int c, std::span<const double> values, TexelCoding coding,
               Put put) {
    int x = 0;
    for (const double value : values) {
        const double v =
            q.logarithmic ? (dmath::log2(value) - q.low) / q.unit.x : value / q.unit[c];
        put(x++, q.is_coded() ? vector_code(v, coding) : texel_code(v, coding));
    }
}

/// Maps, which are all sampled at the same place, go between each other by fours; a pair would
/// leave half of each quartet empty.
void gather_quartets(std::vector<TexturePtr>& units) {
    std::vector<std::size_t> maps;
    for (std::size_t i = 0; i < units.size(); ++i)
        if (units[i]) maps.push_back(i);
    for (std::span<const std::size_t> rest = maps; rest.size() >= 3;) {
        const std::span<const std::size_t> four = rest.first(std::min<std::size_t>(rest.size(), 4));
        std::vector<TexturePtr> textures;
        for (const std::size_t i : four) textures.push_back(units[i]);
        textures = Texture::quartet(textures);
        for (std::size_t k = 0; k < four.size(); ++k) units[four[k]] = std::move(textures[k]);
        rest = rest.subspan(four.size());
    }
}

}  // namespace

glm::dvec3 LayerQuantity::decoded(const glm::dvec3& x) const {
    const glm::dvec3 value = scale * x + offset;
    return logarithmic ? glm::dvec3(dmath::exp2(value.x)) : value;
}

TexelCoding texel_coding(NumberModel numbers) {
    return numbers == NumberModel::wide ? TexelCoding::words : TexelCoding::bytes;
}

BakedTextures bake(const Plan& plan, const Schedule& schedule, TexelQuantities& texels,
                   TexelCoding coding, const Machine& machine) {
    const TexelSource& source = texels.source();
    BakedTextures baked;
    baked.units.resize(schedule.material.units.size());
    std::vector<std::unique_ptr<TexelImage>> images(baked.units.size());
    for (const QuantityPlace& place : schedule.quantities) {
        auto& image = images[static_cast<std::size_t>(place.unit)];
        if (!image) image = std::make_unique<TexelImage>(coding);
    }
    const int levels = plan.quantities.empty() ? 0 : source.levels();
    for (int level = 0; level < levels; ++level) {
        for (const auto& image : images) {
            if (image) image->add_level(source.width(level), source.height(level));
        }
        for (int y = 0; y < source.height(level); ++y) {
            source.require_wanted();
            texels.seek(level, y);
            for (std::size_t i = 0; i < plan.quantities.size(); ++i) {
                const PlanQuantity& q = plan.quantities[i];
                const QuantityPlace& place = schedule.quantities[i];
                TexelImage& image = *images[static_cast<std::size_t>(place.unit)];
                for (int c = 0; c < (place.alpha ? 1 : 3); ++c)
                    write_row(q, c, texels.component(*q.expr, c), coding,
                              [&](int x, int code) { image.put(x, y, place.alpha ? 3 : c, code); });
            }
        }
    }
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (!images[i]) continue;
        baked.units[i] = images[i]->texture(
            {.sampler = source.sampler(), .box_mipmaps = source.averages_layer()});
    }
    if (coding == TexelCoding::words) gather_quartets(baked.units);
    for (std::size_t i = 0; i < plan.quantities.size(); ++i) {
        LayerQuantity d = description(plan.quantities[i], coding);
        d.texture = baked.units[static_cast<std::size_t>(schedule.quantities[i].unit)];
        d.channel = schedule.quantities[i].alpha ? 3 : 0;
        baked.layer.push_back(std::move(d));
    }
    for (std::size_t i = 0; i < plan.tables.size(); ++i) {
        baked.units[static_cast<std::size_t>(schedule.tables[i])] =
            table_texture(plan.tables[i], coding, machine);
    }
    return baked;
}

}  // namespace burnish
