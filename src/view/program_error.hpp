#pragma once

#include <fmt/format.h>

#include <burnish/program_place.hpp>
#include <burnish/scene.hpp>
#include <memory>
#include <string>
#include <vector>

namespace burnish::view {

/// What is wrong with a program that a hand edited.
struct ProgramError {
    std::string material;
    std::size_t line = 0, column = 0;  ///< from 1; 0: not known
    std::string message;
    friend bool operator==(const ProgramError&, const ProgramError&) = default;
};

/// Where it is and what it is: "line 3, column 7: ...".
inline std::string located(const ProgramError& error) {
    if (error.line == 0) return error.message;
    if (error.column == 0) return fmt::format("line {}: {}", error.line, error.message);
    return fmt::format("line {}, column {}: {}", error.line, error.column, error.message);
}

/// The same for a line that stands alone.
inline std::string of_material(const ProgramError& error) {
    return fmt::format("material '{}', its text{} {}", error.material, error.line == 0 ? ":" : ",",
                       located(error));
}

/// An edited program of a scene.
struct ProgramEdit {
    std::shared_ptr<const Material> loaded;  ///< before anybody edited it
    std::vector<std::size_t> objects;        ///< numbers of those that have it
    ProgramLines lines;  ///< in the newest text; none where that is no program and an older one is
                         ///< drawn
};

}  // namespace burnish::view
