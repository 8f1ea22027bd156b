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
    return {.name = "mesh",
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
            .command = [options] { return *options; }};
}

}  // namespace burnish::app
