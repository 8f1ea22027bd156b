#pragma once

#include <burnish/scene.hpp>
#include <burnish/texture.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace burnish {

/// Brushed steel for the modified anisotropic Blinn-Phong model, with generated maps of 512 x 512
/// texels; the marks run along u. Another seed gives other scratches.
Material brushed_steel(std::uint32_t seed = 1);

/// The names that scene files give to the models, those of the enumeration; `text` has none.
std::vector<std::string_view> model_names();

/// One of these; empty for `text`.
std::string_view model_name(Model model);

/// The model with that name; nothing for an unknown one.
std::optional<Model> model_named(std::string_view name);

/// The words of scene files for the methods, in the order of the enumeration.
std::vector<std::string_view> mip_method_names();
std::optional<MipMethod> mip_method_named(std::string_view name);

/// A number that is coded as a channel 0 .. 1: low + (high - low) * channel.
struct CodedRange {
    float low = 0.0F, high = 1.0F;
};

/// A surface whose parameters vary from texel to texel, with the true numbers and as maps.
///
/// Arrays hold size * size texels, rows packed, row 0 on top. y is towards smaller rows. The
/// tangent runs along the marks, where the lobe is narrow: alpha_x <= alpha_y.
struct GeneratedSet {
    std::string name;
    int size = 0;
    bool tiles = true;                 ///< repeats in both directions without a seam
    Model model = Model::abp;          ///< that the numbers are meant for
    std::vector<glm::vec2> direction;  ///< unit: cosine and sine of the tangent's angle from u
    std::vector<glm::vec3> normal;     ///< unit
    std::vector<float> alpha_x, alpha_y;
    std::vector<float> exponent;  ///< N
    std::vector<glm::vec3> kd, ks;

    Image8 direction_map;  ///< r, g: VectorEncoding::d of the direction
    Image8 normal_map;     ///< the same of the normal
    Image8 alpha_map;      ///< r, g, b: alpha_x, alpha_y and N in their ranges
    Image8 kd_map;         ///< kd / kd_scale
    Image8 ks_map;         ///< ks / ks_scale
    CodedRange alpha_x_range, alpha_y_range, exponent_range;
    float kd_scale = 1.0F, ks_scale = 1.0F;  ///< the largest value of any channel

    /// What is the same everywhere needs no map: a direction along u, an upright normal, a colour.
    bool direction_varies = false, normal_varies = false, kd_varies = false, ks_varies = false;
};

/// brushed, lathe, cross_hatch, sunburst, orbital, corrosion, fingerprint, weave.
std::vector<std::string_view> generated_set_names();

/// Largest side of a generated set.
inline constexpr int kMaxGeneratedSize = 2048;

/// The same numbers for the same arguments on every machine. `size` is the side in texels, 1 ..
/// kMaxGeneratedSize; marks scale with it, down to about a texel.
/// Throws Error{bad_option} for an unknown name or another size.
GeneratedSet generated_set(std::string_view name, std::uint32_t seed = 1, int size = 512);

/// The maps of such a set, those that vary, as a material of that name.
Material generated_material(const GeneratedSet& set);
Material generated_material(std::string_view name, std::uint32_t seed = 1, int size = 512);

}  // namespace burnish
