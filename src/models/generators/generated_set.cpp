#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <cmath>
#include <memory>
#include <string>

#include "core/nearest.hpp"
#include "models/generators/surface.hpp"
#include "models/vector_encoding.hpp"

namespace burnish {
namespace {

struct Generator {
    std::string_view name;
    generators::Surface (*surface)(std::uint32_t seed, int size);
    bool tiles;
    Model model;
};
constexpr std::array<Generator, 8> kGenerators{
    {{"brushed", generators::brushed, true, Model::abp_modified},
     {"lathe", generators::lathe, false, Model::abp},
     {"cross_hatch", generators::cross_hatch, true, Model::abp},
     {"sunburst", generators::sunburst, false, Model::abp},
     {"orbital", generators::orbital, true, Model::abp},
     {"corrosion", generators::corrosion, true, Model::abp},
     {"fingerprint", generators::fingerprint, false, Model::abp},
     {"weave", generators::weave, true, Model::abp}}};

const Generator& generator_named(std::string_view name) {
    for (const Generator& generator : kGenerators) {
        if (generator.name == name) return generator;
    }
    throw Error(ErrorCode::bad_option, "unknown generated set '" + std::string(name) + "', " +
                                           expected_one_of(name, generated_set_names()));
}

void store(GeneratedSet& set, const generators::SurfaceTexel& texel) {
    set.direction.emplace_back(texel.direction);
    set.normal.emplace_back(texel.normal);
    set.alpha_x.push_back(static_cast<float>(texel.alpha_x));
    set.alpha_y.push_back(static_cast<float>(texel.alpha_y));
    set.exponent.push_back(static_cast<float>(texel.exponent));
    set.kd.emplace_back(texel.kd);
    set.ks.emplace_back(texel.ks);
}

std::uint8_t signed_code(float x) {
    return static_cast<std::uint8_t>(
        encode_vector_code(VectorEncoding::d, static_cast<double>(x), 8));
}

/// `x` of 0 .. 1.
std::uint8_t unsigned_code(double x) {
    return static_cast<std::uint8_t>(std::clamp(std::floor(255.0 * x + 0.5), 0.0, 255.0));
}

CodedRange range_of(const std::vector<float>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {*low, *high};
}

std::uint8_t code_in(const CodedRange& range, float x) {
    if (range.high == range.low) return 0;
    return unsigned_code((static_cast<double>(x) - static_cast<double>(range.low)) /
                         (static_cast<double>(range.high) - static_cast<double>(range.low)));
}

/// The largest value of any channel; 1 where all are 0.
float scale_of(const std::vector<glm::vec3>& colors) {
    float most = 0.0F;
    for (const glm::vec3& c : colors) most = std::max({most, c.r, c.g, c.b});
    return most > 0.0F ? most : 1.0F;
}

void store_color(std::uint8_t* texel, const glm::vec3& color, float scale) {
    for (int k = 0; k < 3; ++k)
        texel[k] = unsigned_code(static_cast<double>(color[k]) / static_cast<double>(scale));
    texel[3] = 255;
}

template <class Value>
bool varies(const std::vector<Value>& values) {
    return std::any_of(values.begin(), values.end(),
                       [&](const Value& v) { return v != values.front(); });
}

void encode(GeneratedSet& set) {
    for (Image8* map :
         {&set.direction_map, &set.normal_map, &set.alpha_map, &set.kd_map, &set.ks_map})
        *map = Image8(set.size, set.size);
    set.alpha_x_range = range_of(set.alpha_x);
    set.alpha_y_range = range_of(set.alpha_y);
    set.exponent_range = range_of(set.exponent);
    set.kd_scale = scale_of(set.kd);
    set.ks_scale = scale_of(set.ks);
    set.direction_varies = varies(set.direction);
    set.normal_varies = varies(set.normal);
    set.kd_varies = varies(set.kd);
    set.ks_varies = varies(set.ks);
    for (std::size_t i = 0; i < set.direction.size(); ++i) {
        std::uint8_t* direction = set.direction_map.rgba.data() + 4 * i;
        std::uint8_t* normal = set.normal_map.rgba.data() + 4 * i;
        std::uint8_t* alpha = set.alpha_map.rgba.data() + 4 * i;
        direction[0] = signed_code(set.direction[i].x);
        direction[1] = signed_code(set.direction[i].y);
        direction[2] = signed_code(0.0F);
        for (int k = 0; k < 3; ++k) normal[k] = signed_code(set.normal[i][k]);
        alpha[0] = code_in(set.alpha_x_range, set.alpha_x[i]);
        alpha[1] = code_in(set.alpha_y_range, set.alpha_y[i]);
        alpha[2] = code_in(set.exponent_range, set.exponent[i]);
        direction[3] = normal[3] = alpha[3] = 255;
        store_color(set.kd_map.rgba.data() + 4 * i, set.kd[i], set.kd_scale);
        store_color(set.ks_map.rgba.data() + 4 * i, set.ks[i], set.ks_scale);
    }
}

/// A map where the parameter varies, else the number.
ParameterMap parameter_map(const TexturePtr& alpha, int channel, const CodedRange& range,
                           float& constant) {
    constant = range.low + 0.5F * (range.high - range.low);
    if (range.low == range.high) return {};
    return {alpha, channel, range.low, range.high};
}

}  // namespace

std::vector<std::string_view> generated_set_names() {
    std::vector<std::string_view> names;
    for (const Generator& generator : kGenerators) names.push_back(generator.name);
    return names;
}

GeneratedSet generated_set(std::string_view name, std::uint32_t seed, int size) {
    const Generator& generator = generator_named(name);
    if (size < 1 || size > kMaxGeneratedSize)
        throw Error(ErrorCode::bad_option, "generated set of side " + std::to_string(size) +
                                               ", expected 1 .. " +
                                               std::to_string(kMaxGeneratedSize));
    GeneratedSet set;
    set.name = generator.name;
    set.size = size;
    set.tiles = generator.tiles;
    set.model = generator.model;
    const generators::Surface surface = generator.surface(seed, size);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) store(set, surface(x, y));
    }
    encode(set);
    return set;
}

Material generated_material(const GeneratedSet& set) {
    Sampler sampler;
    sampler.wrap_s = sampler.wrap_t = set.tiles ? Wrap::repeat : Wrap::clamp_to_edge;
    const auto texture = [&](const Image8& image) {
        return std::make_shared<const Texture>(image, sampler);
    };
    Material material;
    material.name = set.name;
    material.model = set.model;
    material.encoding = VectorEncoding::d;
    if (set.direction_varies) material.direction_map = texture(set.direction_map);
    if (set.normal_varies) material.normal_map = texture(set.normal_map);
    const TexturePtr alpha = texture(set.alpha_map);
    material.alpha_x_map = parameter_map(alpha, 0, set.alpha_x_range, material.alpha_x);
    material.alpha_y_map = parameter_map(alpha, 1, set.alpha_y_range, material.alpha_y);
    material.exponent_map = parameter_map(alpha, 2, set.exponent_range, material.exponent);
    material.kd = set.kd_varies ? glm::vec3(set.kd_scale) : set.kd.front();
    if (set.kd_varies) material.kd_map = texture(set.kd_map);
    material.ks = set.ks_varies ? glm::vec3(set.ks_scale) : set.ks.front();
    if (set.ks_varies) material.specular_map = texture(set.ks_map);
    return material;
}

Material generated_material(std::string_view name, std::uint32_t seed, int size) {
    return generated_material(generated_set(name, seed, size));
}

}  // namespace burnish
