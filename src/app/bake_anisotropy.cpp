#include <fmt/format.h>

#include <burnish/anisotropy.hpp>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <cmath>
#include <filesystem>
#include <string>

#include "app/make_directory.hpp"
#include "app/material_text.hpp"
#include "app/verbs.hpp"

namespace burnish::app {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

[[noreturn]] void fail(const std::string& message) {
    throw Error(ErrorCode::bad_option, "bake anisotropy: " + message);
}

void print_ours(const GltfAnisotropy& gltf, bool json) {
    const LobeWidths w = widths_from_gltf(gltf);
    const double degrees = w.direction * kDegrees;
    if (json)
        fmt::print("{{\"alpha_x\": {}, \"alpha_y\": {}, \"direction\": {}}}\n", w.alpha_x,
                   w.alpha_y, degrees);
    else
        fmt::print("alpha_x = {:.7g}\nalpha_y = {:.7g}\ndirection = {:.7g}\n", w.alpha_x, w.alpha_y,
                   degrees);
}

void print_gltf(const LobeWidths& widths, bool json) {
    const GltfAnisotropy g = gltf_from_widths(widths);
    if (json)
        fmt::print(
            "{{\"roughnessFactor\": {}, \"anisotropyStrength\": {}, \"anisotropyRotation\": {}}}\n",
            g.roughness, g.strength, g.rotation);
    else
        fmt::print(
            "roughnessFactor = {:.7g}\nanisotropyStrength = {:.7g}\n"
            "anisotropyRotation = {:.7g}\n",
            g.roughness, g.strength, g.rotation);
}

void bake_ours(const BakeAnisotropyOptions& options) {
    const Image8 texture = load_image(options.texture);
    const Image8 roughness =
        options.roughness_texture.empty() ? Image8{} : load_image(options.roughness_texture);
    const AnisotropyMaps maps =
        anisotropy_maps_from_gltf(texture, roughness,
                                  {options.roughness.value_or(1.0), options.strength.value_or(1.0),
                                   options.rotation.value_or(0.0)});
    make_directory(options.output);
    save_image(maps.direction, options.output / "direction.png");
    save_image(maps.alpha, options.output / "alpha.png");
    const std::string text =
        "# From KHR_materials_anisotropy: alpha_x lies along its direction. Colours are not "
        "known.\n"
        "schema = 1\n\n" +
        texture_text("direction", "direction.png", true) +
        texture_text("alpha", "alpha.png", true) +
        "[material]\nmodel = \"ggx\"\nencoding = \"d\"\ndirection_map = \"direction\"\n" +
        parameter_text("alpha_x", "alpha", 'r', maps.alpha_x_range) +
        parameter_text("alpha_y", "alpha", 'g', maps.alpha_y_range);
    save_text(text, options.output / "material.toml");
    fmt::print("{}: material.toml, two maps of {} x {}\n", options.output.string(), texture.width,
               texture.height);
}

void bake_gltf(const BakeAnisotropyOptions& options) {
    const GltfAnisotropyMaps maps = gltf_anisotropy_maps(load_material(options.material));
    make_directory(options.output);
    save_image(maps.anisotropy, options.output / "anisotropy.png");
    save_image(maps.roughness, options.output / "roughness.png");
    fmt::print(
        "{}: anisotropy.png, roughness.png of {} x {}, for roughnessFactor 1, "
        "anisotropyStrength 1, anisotropyRotation 0\n",
        options.output.string(), maps.anisotropy.width, maps.anisotropy.height);
}

}  // namespace

void run(const BakeAnisotropyOptions& options) {
    for (const auto& number : {options.roughness, options.strength, options.rotation,
                               options.alpha_x, options.alpha_y, options.direction}) {
        if (number && !std::isfinite(*number)) fail("a number that is none");
    }
    const bool has_texture = !options.texture.empty();
    const bool from_gltf = has_texture || options.roughness || options.strength || options.rotation;
    const bool from_widths = options.alpha_x || options.alpha_y || options.direction;
    const bool from_material = !options.material.empty();
    if (int{from_gltf} + int{from_widths} + int{from_material} != 1)
        fail(
            "expected one of --roughness, --strength, --rotation, --texture; of --alpha-x, "
            "--alpha-y, --direction; or --material");
    if (!options.roughness_texture.empty() && !has_texture)
        fail("--roughness-texture without --texture");
    const bool writes = has_texture || from_material;
    if (writes && options.output.empty()) fail("textures need -o DIR");
    if (!writes && !options.output.empty()) fail("-o without --texture or --material");
    if (writes && options.json) fail("--json prints numbers, and textures are files");
    if (from_widths && !(options.alpha_x && options.alpha_y))
        fail("one width, expected --alpha-x and --alpha-y");
    if (has_texture) return bake_ours(options);
    if (from_material) return bake_gltf(options);
    if (from_gltf)
        print_ours({options.roughness.value_or(1.0), options.strength.value_or(0.0),
                    options.rotation.value_or(0.0)},
                   options.json);
    else
        print_gltf({*options.alpha_x, *options.alpha_y, options.direction.value_or(0.0) / kDegrees},
                   options.json);
}

}  // namespace burnish::app
