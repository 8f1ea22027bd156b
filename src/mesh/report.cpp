#include <fmt/format.h>

#include <burnish/files.hpp>

namespace burnish {
namespace {

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace

std::vector<std::string> MeshReport::notes() const {
    std::vector<std::string> lines;
    if (generated_normals) lines.emplace_back("no normals in some or all places: generated");
    if (generated_uvs)
        lines.emplace_back("no texture coordinates in some or all places: generated");
    if (nonmanifold_faces != 0)
        lines.push_back(fmt::format("{} not manifold: drawn all the same",
                                    counted(nonmanifold_faces, "face is", "faces are")));
    if (degenerate_faces != 0)
        lines.push_back(fmt::format("{} no area: skipped",
                                    counted(degenerate_faces, "face has", "faces have")));
    if (nonfinite_vertices != 0)
        lines.push_back(fmt::format("{} not finite: {} skipped",
                                    counted(nonfinite_vertices, "vertex is", "vertices are"),
                                    counted(nonfinite_faces, "face", "faces")));
    return lines;
}

}  // namespace burnish
