#include <fmt/format.h>

#include <burnish/files.hpp>
#include <burnish/materials.hpp>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/make_directory.hpp"
#include "app/material_text.hpp"
#include "app/progress.hpp"
#include "app/verbs.hpp"

namespace burnish::app {
namespace {

/// Numbers of a set as an EXR file: `texel(i)` as r, g, b.
template <class Texel>
void save_truth(const GeneratedSet& set, const std::filesystem::path& path, const Texel& texel) {
    Framebuffer frame(set.size, set.size, PixelFormat::rgba32f);
    std::size_t i = 0;
    for (int y = 0; y < set.size; ++y) {
        for (int x = 0; x < set.size; ++x, ++i) {
            const glm::vec4 value(texel(i), 1.0F);
            std::memcpy(frame.row(y) + static_cast<std::size_t>(x) * sizeof value, &value,
                        sizeof value);
        }
    }
    save_image(frame, path);
}

/// The maps that vary, and what their files are called.
std::vector<std::pair<std::string_view, const Image8*>> maps_of(const GeneratedSet& set) {
    std::vector<std::pair<std::string_view, const Image8*>> maps{{"alpha", &set.alpha_map}};
    if (set.direction_varies) maps.emplace_back("direction", &set.direction_map);
    if (set.normal_varies) maps.emplace_back("normal", &set.normal_map);
    if (set.kd_varies) maps.emplace_back("kd", &set.kd_map);
    if (set.ks_varies) maps.emplace_back("ks", &set.ks_map);
    return maps;
}

std::string material_text(const GeneratedSet& set, std::string_view model, std::uint32_t seed) {
    std::string text = fmt::format(
        "# burnish bake material {} --seed {} --size {}\n"
        "# The true numbers stand in the truth_*.exr files: direction and normal as they are;\n"
        "# parameters: alpha_x, alpha_y, N; kd; ks.\n"
        "schema = 1\n\n",
        set.name, seed, set.size);
    for (const auto& [name, image] : maps_of(set))
        text += texture_text(name, fmt::format("{}.png", name), set.tiles);
    text += fmt::format("[material]\nname = \"{}\"\nmodel = \"{}\"\nencoding = \"d\"\n", set.name,
                        model);
    if (set.direction_varies) text += "direction_map = \"direction\"\n";
    if (set.normal_varies) text += "normal_map = \"normal\"\n";
    text += parameter_text("alpha_x", "alpha", 'r', set.alpha_x_range);
    text += parameter_text("alpha_y", "alpha", 'g', set.alpha_y_range);
    text += parameter_text("exponent", "alpha", 'b', set.exponent_range);
    text += set.kd_varies ? color_text("kd", "kd", set.kd_scale) : color_text("kd", set.kd.front());
    text += set.ks_varies ? color_text("ks", "ks", set.ks_scale) : color_text("ks", set.ks.front());
    return text;
}

}  // namespace

void run(const BakeMaterialOptions& options) {
    Progress progress(false);
    const GeneratedSet set = generated_set(options.set, options.seed, options.size);
    const std::filesystem::path& directory = options.output;
    make_directory(directory);
    for (const auto& [name, image] : maps_of(set))
        save_image(*image, directory / fmt::format("{}.png", name));
    save_truth(set, directory / "truth_direction.exr",
               [&](std::size_t i) { return glm::vec3(set.direction[i], 0.0F); });
    save_truth(set, directory / "truth_normal.exr", [&](std::size_t i) { return set.normal[i]; });
    save_truth(set, directory / "truth_parameters.exr", [&](std::size_t i) {
        return glm::vec3(set.alpha_x[i], set.alpha_y[i], set.exponent[i]);
    });
    save_truth(set, directory / "truth_kd.exr", [&](std::size_t i) { return set.kd[i]; });
    save_truth(set, directory / "truth_ks.exr", [&](std::size_t i) { return set.ks[i]; });
    save_text(material_text(set, model_name(set.model), options.seed), directory / "material.toml");
    progress.finish();
    fmt::print("{}: material.toml, {} maps of {} x {}, five files of true numbers\n",
               directory.string(), maps_of(set).size(), options.size, options.size);
}

}  // namespace burnish::app
