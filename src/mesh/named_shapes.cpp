#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/shapes.hpp>

#include "core/nearest.hpp"

namespace burnish::shapes {

std::vector<std::string_view> names() {
    return {"sphere", "knot", "plane", "cube", "ribbon"};
}

MeshData named(std::string_view name, int columns, int rows) {
    if (name == "sphere") return sphere(columns, rows);
    if (name == "knot") return torus_knot(columns, rows);
    if (name == "plane") return plane(columns, rows);
    if (name == "cube") return cube();
    if (name == "ribbon") return ribbon(columns, rows);
    throw Error(ErrorCode::bad_option,
                fmt::format("unknown shape '{}', {}", name, expected_one_of(name, names())));
}

}  // namespace burnish::shapes
