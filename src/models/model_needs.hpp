#pragma once

#include <burnish/error.hpp>
#include <burnish/machine.hpp>
#include <cstddef>
#include <string>

namespace burnish {

/// What a model takes of a machine that draws it in one pass.
struct ModelNeeds {
    int tables = 0;                ///< fetches that depend on what combiners computed
    int units = 0;                 ///< texture units: maps, tables, a third vector
    int stages = 0;                ///< general stages; 0: not known
    bool stage_constants = false;  ///< constants may differ from stage to stage
    bool third_vector = false;     ///< l, v and h: the third one comes through a texture unit
};

/// All that `machine` has too little of, with counts, as one line: "needs 6 texture units, the
/// machine has 2; needs 5 general stages, it has 2". Empty if it has everything.
std::string shortages(const ModelNeeds& needs, const Machine& machine);

/// The first thing that is short, for compile_model, which tells the rest as well.
struct Shortage : Error {
    explicit Shortage(const std::string& message, const ModelNeeds& known = {})
        : Error(ErrorCode::bad_program, message), needs(known) {}

    ModelNeeds needs;                  ///< as far as it is known
    std::size_t line = 0, column = 0;  ///< of the expression; 0: of none alone
};

}  // namespace burnish
