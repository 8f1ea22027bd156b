#include <fmt/format.h>

#include <burnish/machine.hpp>
#include <burnish/materials.hpp>
#include <burnish/renderer.hpp>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "app/verbs.hpp"

namespace burnish::app {
namespace {

struct Info {
    std::string isa;
    int threads;
    std::vector<std::string_view> available, built;
    std::vector<std::string_view> meshes{"obj", "ply", "off", "stl"};
    std::vector<std::string_view> meshes_written{"ply", "obj"};
    std::vector<std::string_view> scenes{"toml"};
};

Info collect() {
    const Renderer renderer;
    Info info{std::string(renderer.isa()), renderer.threads(), {}, {}};
    for (const IsaInfo& isa : instruction_sets()) {
        info.built.push_back(isa.name);
        if (isa.available) info.available.push_back(isa.name);
    }
    return info;
}

std::string joined(const std::vector<std::string_view>& names) {
    return fmt::format("{}", fmt::join(names, " "));
}

/// Names here are plain words: nothing to escape.
std::string json_list(const std::vector<std::string_view>& names) {
    std::string list;
    for (const std::string_view name : names)
        list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", name);
    return "[" + list + "]";
}

}  // namespace

void run(const InfoOptions& options) {
    const Info info = collect();
    if (options.json) {
        fmt::print(
            "{{\"version\": \"{}\", \"isa\": \"{}\", \"isa_available\": {}, \"isa_built\": {}, "
            "\"threads\": {}, \"profiles\": {}, \"models\": {}, \"scene_formats\": {}, "
            "\"mesh_formats\": {}, \"mesh_formats_written\": {}, \"image_formats\": "
            "\"OpenImageIO\"}}\n",
            BURNISH_VERSION, info.isa, json_list(info.available), json_list(info.built),
            info.threads, json_list(machine_profile_names()), json_list(model_names()),
            json_list(info.scenes), json_list(info.meshes), json_list(info.meshes_written));
        return;
    }
    fmt::print(
        "burnish {}\n"
        "instruction set  {} (available: {}; built: {})\n"
        "threads          {}\n"
        "profiles         {}\n"
        "models           {}\n"
        "scenes           {}\n"
        "meshes           {} (written: {})\n"
        "images           png exr jpg tif and whatever else OpenImageIO reads and writes\n",
        BURNISH_VERSION, info.isa, joined(info.available), joined(info.built), info.threads,
        joined(machine_profile_names()), joined(model_names()), joined(info.scenes),
        joined(info.meshes), joined(info.meshes_written));
}

void run(const PrintText& text) {
    fmt::print("{}", text.text);
}

}  // namespace burnish::app
