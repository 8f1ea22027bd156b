#include <fmt/format.h>

#include <burnish/shapes.hpp>
#include <limits>
#include <memory>

#include "app/options/bake.hpp"
#include "app/options/numbers.hpp"
#include "app/options/words.hpp"

namespace burnish::app {

Verb bake_mesh_verb() {
    constexpr int kLeast = std::numeric_limits<int>::min();  // shapes say how many they can have
    constexpr int kMost = std::numeric_limits<int>::max();
    const auto options = std::make_shared<BakeMeshOptions>();
    return {
        .name = "mesh",
        .text = "A test mesh",
        .groups = {{"Mesh",
                    {{.names = "SHAPE",
                      .text = fmt::format("{}", fmt::join(shapes::names(), ", ")),
                      .words = shapes::names(),
                      .required = true,
                      .set = text_to(options->shape)},
                     {.names = "--columns",
                      .value = "N",
                      .text = "Columns of the grid; segments along the knot",
                      .normal = fmt::format("{}", options->columns),
                      .set = number_to(options->columns, kLeast, kMost)},
                     {.names = "--rows",
                      .value = "N",
                      .text = "Rows of the grid; sides of the knot's tube",
                      .normal = fmt::format("{}", options->rows),
                      .set = number_to(options->rows, kLeast, kMost)}}},
                   {"Output",
                    {{.names = "-o,--output",
                      .value = "FILE",
                      .text = "Mesh file, .ply or .obj",
                      .files = "ply obj",
                      .required = true,
                      .set = text_to(options->output)}}}},
        .examples = {{"A torus knot as text", "burnish bake mesh knot -o knot.obj"},
                     {"A fine sphere as binary PLY",
                      "burnish bake mesh sphere --columns 256 --rows 128 -o sphere.ply"},
                     {"A plane of one cell",
                      "burnish bake mesh plane --columns 1 --rows 1 -o plane.ply"},
                     {"A mesh and its picture",
                      "burnish bake mesh cube -o cube.ply && burnish render cube.ply -o cube.png"}},
        .command = [options] { return *options; }};
}

}  // namespace burnish::app
