#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/framebuffer.hpp>
#include <burnish/machine.hpp>
#include <iterator>

#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "app/options/words.hpp"

namespace burnish::app {
namespace {

Set size_to(std::optional<glm::ivec2>& target) {
    return [&target](const std::string& option, const std::string& text) {
        glm::ivec2 size{0, 0};
        if (!parse_pair(text, 'x', size) || size.x < 1 || size.y < 1 ||
            size.x > Framebuffer::kMaxSize || size.y > Framebuffer::kMaxSize)
            refuse(option, text, fmt::format("WIDTHxHEIGHT, each 1 .. {}", Framebuffer::kMaxSize));
        target = size;
    };
}

Light parse_light(const std::string& option, const std::string& text) {
    const std::vector<float> v = parse_numbers(option, text, 3, 4);
    Light light;
    light.position = {v[0], v[1], v[2]};
    light.position_w = v.size() == 4 ? v[3] : 0.0F;
    if (light.position_w != 0.0F && light.position_w != 1.0F)
        refuse(option, text, "W = 0 for a direction or 1 for a position");
    if (light.position_w == 0.0F && light.position == glm::vec3(0.0F))
        refuse(option, text, "a direction that is not zero");
    return light;
}

glm::vec4 parse_background(const std::string& option, const std::string& text) {
    const std::vector<float> v = parse_numbers(option, text, 3, 4);
    for (const float value : v)
        if (value < 0.0F || value > 1.0F) refuse(option, text, "numbers of 0 .. 1");
    return {v[0], v[1], v[2], v.size() == 4 ? v[3] : 1.0F};
}

OptionGroup input_options(PictureOptions& picture) {
    return {"Input",
            {{.names = "INPUT",
              .text = "Scene (.toml) or mesh (.obj .ply .off .stl)",
              .files = "toml obj ply off stl",
              .required = true,
              .set = text_to(picture.input)},
             {.names = "-D",
              .value = "KEY.PATH=VALUE",
              .text = "Any key of the scene, e.g. -D camera.near=0.5",
              .repeated = true,
              .set = [&picture](const std::string&, const std::string& text) {
                  picture.overrides.push_back(text);
              }}}};
}

OptionGroup material_options(PictureOptions& picture) {
    return {"Material",
            {{.names = "--material",
              .value = "FILE",
              .text = "Material file (.toml) for every mesh, instead of its own",
              .files = "toml",
              .set = text_to(picture.material)},
             {.names = "--model",
              .value = "NAME",
              .text = "Reflectance model of every mesh, instead of its material's; `burnish info` "
                      "lists them",
              .words = model_names(),
              .set = [&picture](const std::string&,
                                const std::string& name) { picture.model = model_named(name); }},
             {.names = "--mipmaps",
              .value = "METHOD[:BITS]",
              .text = fmt::format("How mip levels of every reflectance model's parameters are "
                                  "made: {}; their moments stored in 8, 16 or 32 bits",
                                  fmt::join(mip_method_names(), ", ")),
              .normal = "the material's",
              .words = mip_method_names(),
              .open_words = true,
              .set =
                  [&picture](const std::string& option, const std::string& text) {
                      picture.mipmaps = parse_mipmaps(option, text);
                  }},
             {.names = "--max-anisotropy",
              .value = "N",
              .text = "Most probes along the longer axis of what a pixel covers, 1 .. 16, of every "
                      "reflectance model with mipmaps",
              .normal = "the material's",
              .set = number_to(picture.max_anisotropy, 1, Sampler::kMostProbes)}}};
}

OptionGroup machine_options(PictureOptions& picture) {
    return {
        "Machine",
        {{.names = "--machine",
          .value = "PROFILE",
          .text = "Machine profile: geforce256, nv2a or ideal; or double, formulas instead of a "
                  "machine",
          .normal = "the scene's, of a mesh ideal",
          .words = machine_profile_names(),
          .set = text_to(picture.machine)},
         {.names = "--multipass",
          .text = "Split programs that need more than the machine has into passes",
          .set = flag_to(picture.multipass)},
         {.names = "--half-vector",
          .value = "WHERE",
          .text = "Where half vectors are computed: pixel, vertex, or cube:N, per vertex and "
                  "normalised by a cube map of N texels a side",
          .normal = "the machine's",
          .words = {"pixel", "vertex", "cube:"},
          .open_words = true,
          .set =
              [&picture](const std::string&, const std::string& word) {
                  Machine tried;
                  choose_half_vector(tried, word);
                  picture.half_vector = word;
              }},
         {.names = "--filter-order",
          .value = "ORDER",
          .text = "Textures are filtered before the combiners, or their results afterwards: before "
                  "or after",
          .normal = "the machine's",
          .words = {"before", "after"},
          .open_words = true,
          .set = [&picture](const std::string&, const std::string& word) {
              picture.filter_order = filter_order_of(word);
          }}}};
}

OptionGroup view_options(PictureOptions& picture) {
    return {"Picture",
            {{.names = "--size",
              .value = "WxH",
              .text = "Size of the picture in pixels",
              .normal = "the scene's, of a mesh 1280x720",
              .set = size_to(picture.size)},
             {.names = "--background",
              .value = "R,G,B[,A]",
              .text = "Colour where nothing is drawn, 0 .. 1",
              .normal = "the scene's",
              .set =
                  [&picture](const std::string& option, const std::string& text) {
                      picture.background = parse_background(option, text);
                  }},
             {.names = "--light",
              .value = "X,Y,Z[,W]",
              .text = "A light, instead of the scene's: direction towards it, or its position if W "
                      "is 1; may be given several times",
              .repeated = true,
              .set = [&picture](const std::string& option, const std::string& text) {
                  picture.lights.push_back(parse_light(option, text));
              }}}};
}

std::vector<std::string_view> isa_names() {
    std::vector<std::string_view> names;
    for (const IsaInfo& isa : instruction_sets()) names.push_back(isa.name);
    return names;
}

OptionGroup work_options(PictureOptions& picture) {
    return {"Work",
            {threads_option(picture.threads),
             {.names = "--isa",
              .value = "NAME",
              .text = "Instruction set; `burnish info` lists them",
              .normal = "the widest",
              .words = isa_names(),
              .set = text_to(picture.isa)},
             quiet_option(picture.quiet),
             {.names = "-v,--verbose",
              .text = "Print what was loaded and drawn",
              .excludes = "--quiet",
              .set = flag_to(picture.verbose)}}};
}

}  // namespace

std::vector<OptionGroup> with_picture_options(PictureOptions& picture,
                                              std::vector<OptionGroup> own) {
    std::vector<OptionGroup> groups{input_options(picture)};
    std::move(own.begin(), own.end(), std::back_inserter(groups));
    groups.push_back(view_options(picture));
    groups.push_back(camera_options(picture.camera));
    groups.push_back(material_options(picture));
    groups.push_back(machine_options(picture));
    groups.push_back(work_options(picture));
    return groups;
}

Option samples_option(int& side) {
    return {.names = "--samples",
            .value = "N",
            .text = "Samples per pixel: 1, 4, 9 or 16; with profile double any square up to 1024",
            .normal = fmt::format("{}", side * side),
            .set = [&side](const std::string& option, const std::string& text) {
                for (side = 1; side <= 32; ++side)
                    if (text == fmt::format("{}", side * side)) return;
                refuse(option, text, "a square, 1 .. 1024");
            }};
}

Option threads_option(int& threads) {
    return {.names = "--threads",
            .value = "N",
            .text = "Workers, exactly that many; 0: one per core",
            .normal = fmt::format("{}", threads),
            .set = number_to<int>(threads, 0, 1024)};
}

Option json_option(bool& json) {
    return {.names = "--json", .text = "Print JSON", .set = flag_to(json)};
}

Option quiet_option(bool& quiet) {
    return {.names = "--quiet", .text = "Print errors only", .set = flag_to(quiet)};
}

}  // namespace burnish::app
