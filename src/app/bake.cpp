#include <fmt/format.h>

#include <burnish/files.hpp>
#include <burnish/shapes.hpp>
#include <filesystem>

#include "app/progress.hpp"
#include "app/verbs.hpp"
#include "models/generators/brushed.hpp"

namespace burnish::app {
namespace {

/// "DIR/normal.png" for a directory, "PREFIX-normal.png" for anything else.
std::filesystem::path map_path(const std::filesystem::path& output, const std::string& name) {
    std::error_code ignored;
    const bool directory =
        output.filename().empty() || std::filesystem::is_directory(output, ignored);
    if (directory) return output / (name + ".png");
    return output.parent_path() / (output.filename().string() + "-" + name + ".png");
}

}  // namespace

void run(const BakeBrushedOptions& options) {
    Progress progress(false);
    const BrushedMaps maps = brushed_maps(options.seed, options.size);
    save_image(maps.normal, map_path(options.output, "normal"));
    save_image(maps.tangent, map_path(options.output, "tangent"));
    save_image(maps.bitangent, map_path(options.output, "bitangent"));
    save_image(maps.specular, map_path(options.output, "specular"));
    progress.finish();
    fmt::print("{}: four maps of {} x {}, map_scale = {}\n", map_path(options.output, "*").string(),
               options.size, options.size, maps.map_scale);
}

void run(const BakeMeshOptions& options) {
    Progress progress(false);
    const MeshData mesh = shapes::named(options.shape, options.columns, options.rows);
    save_mesh(mesh, options.output);
    progress.finish();
    fmt::print("{}: {} vertices, {} triangles\n", options.output.string(), mesh.positions.size(),
               mesh.indices.size() / 3);
}

}  // namespace burnish::app
