#include "machine/fetches.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>

namespace burnish {

int coordinate_count(FetchTarget target) {
    switch (target) {
        case FetchTarget::table_1d:
            return 1;
        case FetchTarget::table_2d:
        case FetchTarget::table_rectangle:
            return 2;
        default:
            return 3;
    }
}

void require_no_fetches(const CombinerProgram& program) {
    for (std::size_t i = 0; i < program.stages.size(); ++i) {
        if (!program.stages[i].fetches.empty())
            throw Error(
                ErrorCode::bad_program,
                fmt::format("stage {}: fetches, but there are no textures to fetch from", i));
    }
}

}  // namespace burnish
