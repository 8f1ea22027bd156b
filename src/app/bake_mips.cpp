#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <burnish/materials.hpp>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "app/make_directory.hpp"
#include "app/material_text.hpp"
#include "app/progress.hpp"
#include "app/verbs.hpp"
#include "models/mips/slope_lobe.hpp"
#include "models/texel.hpp"
#include "models/vector_encoding.hpp"

namespace burnish::app {
namespace {

constexpr double kMostCode = 65535.0;
constexpr VectorEncoding kEncoding = VectorEncoding::b;  // 0 and 1 are exact

/// The smallest and the largest value over all texels of all levels.
template <class ValueOf>
CodedRange range_of(const TexelSource& source, const ValueOf& value_of) {
    double low = value_of(source.at(0, 0)), high = low;
    for (int level = 0; level < source.levels(); ++level) {
        for (int y = 0; y < source.height(level); ++y) {
            for (int x = 0; x < source.width(level); ++x) {
                const double value = value_of(source.at(level, x, y));
                low = std::min(low, value);
                high = std::max(high, value);
            }
        }
    }
    return {static_cast<float>(low), static_cast<float>(high)};
}

double largest(const glm::dvec3& c) {
    return std::max({c.r, c.g, c.b});
}

/// How the maps' numbers are coded.
struct Codes {
    CodedRange alpha_x, alpha_y, exponent;
    float kd, ks;  ///< 0 .. 1: what the maps are multiplied with

    explicit Codes(const TexelSource& source)
        : alpha_x(range_of(source, [](const TexelParameters& p) { return p.alpha_x; })),
          alpha_y(range_of(source, [](const TexelParameters& p) { return p.alpha_y; })),
          exponent(range_of(source, [](const TexelParameters& p) { return p.exponent; })),
          kd(std::min(range_of(source, [](const auto& p) { return largest(p.kd); }).high, 1.0F)),
          ks(std::min(range_of(source, [](const auto& p) { return largest(p.ks); }).high, 1.0F)) {}
};

double within(const CodedRange& range, double x) {
    const auto low = static_cast<double>(range.low), high = static_cast<double>(range.high);
    return high > low ? (x - low) / (high - low) : 0.0;
}

glm::dvec3 scaled(const glm::dvec3& color, float scale) {
    return scale > 0.0F ? color / static_cast<double>(scale) : glm::dvec3(0.0);
}

/// Vectors as codes over the largest one.
glm::dvec3 coded(const glm::dvec3& v) {
    glm::dvec3 codes;
    for (int c = 0; c < 3; ++c) codes[c] = encode_vector_code(kEncoding, v[c], 16) / kMostCode;
    return codes;
}

struct Map {
    std::string_view name;
    glm::dvec3 (*value)(const TexelParameters&, const Codes&);  ///< r, g, b of 0 .. 1
};
constexpr Map kMaps[] = {
    {"normal", [](const TexelParameters& p, const Codes&) { return coded(p.n); }},
    {"direction",
     [](const TexelParameters& p, const Codes&) {
         const glm::dvec2 v = mips::surface_direction(p);
         const double length = std::sqrt(glm::dot(v, v));
         return coded(length > 0.0 ? glm::dvec3(v / length, 0.0) : glm::dvec3(1.0, 0.0, 0.0));
     }},
    {"alpha",
     [](const TexelParameters& p, const Codes& c) {
         return glm::dvec3(within(c.alpha_x, p.alpha_x), within(c.alpha_y, p.alpha_y),
                           within(c.exponent, p.exponent));
     }},
    {"kd", [](const TexelParameters& p, const Codes& c) { return scaled(p.kd, c.kd); }},
    {"ks", [](const TexelParameters& p, const Codes& c) { return scaled(p.ks, c.ks); }}};

std::string file_name(const Map& map, int level) {
    return fmt::format("{}_{}.png", map.name, level);
}

void save_level(const TexelSource& source, int level, const Map& map, const Codes& codes,
                const std::filesystem::path& path) {
    Framebuffer frame(source.width(level), source.height(level), PixelFormat::rgba16);
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const glm::dvec3 value = map.value(source.at(level, x, y), codes);
            std::uint16_t texel[4] = {0, 0, 0, 65535};
            for (int c = 0; c < 3; ++c)
                texel[c] = static_cast<std::uint16_t>(
                    std::floor(std::clamp(value[c], 0.0, 1.0) * kMostCode + 0.5));
            std::memcpy(frame.row(y) + static_cast<std::size_t>(x) * sizeof texel, texel,
                        sizeof texel);
        }
    }
    save_image(frame, path);
}

std::string_view wrap_name(Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return "repeat";
        case Wrap::mirrored_repeat:
            return "mirrored_repeat";
        case Wrap::clamp_to_edge:
        case Wrap::clamp_to_border:
            break;
    }
    return "clamp_to_edge";
}

std::string texture_text(const TexelSource& source, const Map& map) {
    const Sampler& sampler = source.sampler();
    std::string text = fmt::format(
        "[[textures]]\nname = \"{}\"\nfile = \"{}\"\nformat = \"rgba16\"\n"
        "filter = \"linear_mipmap_linear\"\nwrap = [\"{}\", \"{}\"]\n",
        map.name, file_name(map, 0), wrap_name(sampler.wrap_s), wrap_name(sampler.wrap_t));
    if (source.levels() > 1) {
        text += "mipmaps = \"files\"\nmip_files = [";
        for (int level = 1; level < source.levels(); ++level)
            text += fmt::format("{}\"{}\"", level > 1 ? ", " : "", file_name(map, level));
        text += "]\n";
    }
    return text + "\n";
}

std::string material_text(const Material& material, const TexelSource& source, const Codes& codes) {
    std::string text = "schema = 1\n\n";
    for (const Map& map : kMaps) text += texture_text(source, map);
    text += fmt::format("[material]\nname = \"{}\"\n", material.name);
    text += material.model == Model::text
                ? fmt::format("model_text = '''\n{}'''\n", material.model_text)
                : fmt::format("model = \"{}\"\n", model_name(material.model));
    text +=
        "encoding = \"b\"\nmipmaps = \"maps\"\nnormal_map = \"normal\"\n"
        "direction_map = \"direction\"\n";
    text += parameter_text("alpha_x", "alpha", 'r', codes.alpha_x);
    text += parameter_text("alpha_y", "alpha", 'g', codes.alpha_y);
    text += parameter_text("exponent", "alpha", 'b', codes.exponent);
    return text + color_text("kd", "kd", codes.kd) + color_text("ks", "ks", codes.ks);
}

}  // namespace

void run(const BakeMipsOptions& options) {
    Progress progress(false);
    Material material = options.material.empty()
                            ? generated_material(options.set, options.seed, options.size)
                            : load_material(options.material);
    if (material.program)
        throw Error(
            ErrorCode::bad_input,
            fmt::format("{}: a pipeline, expected a reflectance model", options.material.string()));
    material.mipmaps = options.mipmaps;
    const TexelSource source(material);
    const Codes codes(source);
    make_directory(options.output);
    const std::size_t files = std::size(kMaps) * static_cast<std::size_t>(source.levels());
    std::size_t saved = 0;
    for (const Map& map : kMaps) {
        for (int level = 0; level < source.levels(); ++level) {
            save_level(source, level, map, codes, options.output / file_name(map, level));
            progress.done(++saved, files);
        }
    }
    save_text(material_text(material, source, codes), options.output / "material.toml");
    progress.finish();
    fmt::print("{}: material.toml, {} maps of {} x {} with {} levels\n", options.output.string(),
               std::size(kMaps), source.width(), source.height(), source.levels());
}

}  // namespace burnish::app
