#include <burnish/program_place.hpp>

namespace burnish {

std::optional<std::size_t> line_of(const ProgramPlace& place, const ProgramLines& lines) {
    const ProgramPlace part{place.part, place.stage, ProgramPlace::kAll};
    const ProgramPlace stage{ProgramPlace::Part::stage, place.stage, ProgramPlace::kAll};
    for (const ProgramPlace& each : {place, part, stage}) {
        const bool is_final = place.part == ProgramPlace::Part::final_combiner;
        if (is_final && each.part != place.part) break;
        if (const auto at = lines.find(each); at != lines.end()) return at->second;
    }
    return std::nullopt;
}

}  // namespace burnish
