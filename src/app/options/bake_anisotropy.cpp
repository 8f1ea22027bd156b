#include <memory>

#include "app/options/bake.hpp"
#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "app/options/words.hpp"

namespace burnish::app {
namespace {

OptionGroup gltf_options(BakeAnisotropyOptions& options) {
    return {"From glTF",
            {{.names = "--roughness",
              .value = "R",
              .text = "glTF's roughnessFactor",
              .normal = "1",
              .set = number_to(options.roughness, 0.0, 1.0)},
             {.names = "--strength",
              .value = "S",
              .text = "glTF's anisotropyStrength",
              .normal = "0, with --texture 1",
              .set = number_to(options.strength, 0.0, 1.0)},
             {.names = "--rotation",
              .value = "RAD",
              .text = "glTF's anisotropyRotation: radians, against the clock",
              .normal = "0",
              .set = number_to(options.rotation, -1e3, 1e3)},
             {.names = "--texture",
              .value = "FILE",
              .text = "glTF's anisotropyTexture",
              .files = "png",
              .set = text_to(options.texture)},
             {.names = "--roughness-texture",
              .value = "FILE",
              .text = "glTF's metallicRoughnessTexture, of the same size",
              .files = "png",
              .set = text_to(options.roughness_texture)}}};
}

OptionGroup width_options(BakeAnisotropyOptions& options) {
    return {"To glTF",
            {{.names = "--alpha-x",
              .value = "A",
              .text = "Our width along the tangent",
              .set = number_to(options.alpha_x, 0.0, 1.0)},
             {.names = "--alpha-y",
              .value = "A",
              .text = "Our width along the bitangent",
              .set = number_to(options.alpha_y, 0.0, 1.0)},
             {.names = "--direction",
              .value = "DEG",
              .text = "Our tangent's angle from u: degrees, against the clock",
              .normal = "0",
              .set = number_to(options.direction, -1e4, 1e4)},
             {.names = "--material",
              .value = "FILE",
              .text = "Material file, to textures of glTF",
              .files = "toml",
              .set = text_to(options.material)}}};
}

}  // namespace

Verb bake_anisotropy_verb() {
    const auto options = std::make_shared<BakeAnisotropyOptions>();
    Option json = json_option(options->json);
    json.text = "Print numbers as JSON";
    return {
        .name = "anisotropy",
        .text = "KHR_materials_anisotropy to our widths, and back",
        .groups = {gltf_options(*options),
                   width_options(*options),
                   {"Output",
                    {{.names = "-o,--output",
                      .value = "DIR",
                      .text = "Directory for what textures or a material turn into",
                      .files = "/",
                      .set = text_to(options->output)},
                     json}}},
        .examples = {{"Our widths of glTF's numbers",
                      "burnish bake anisotropy --roughness 0.5 --strength 0.6"},
                     {"glTF's numbers of our widths",
                      "burnish bake anisotropy --alpha-x 0.1 --alpha-y 0.4"},
                     {"The same for a script, the tangent turned by 30 degrees",
                      "burnish bake anisotropy --alpha-x 0.1 --alpha-y 0.4 --direction 30 --json"},
                     {"A material's maps as textures of glTF",
                      "burnish bake anisotropy --material meshes/materials/weave.toml -o gltf"}},
        .command = [options] { return *options; }};
}

}  // namespace burnish::app
