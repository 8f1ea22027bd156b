#include "machine/show_register.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>

namespace burnish {

void require_showable(Register reg, const Machine& machine) {
    if (reg >= Register::discard) {
        throw Error(
            ErrorCode::bad_option,
            fmt::format("register {} cannot be shown: it is never read", register_name(reg)));
    }
    if (reg < Register::tex0 || reg > Register::tex15 || reg < tex(machine.texture_units)) return;
    throw Error(ErrorCode::bad_option,
                fmt::format("register {}, machine '{}' has texture units tex0 .. tex{}",
                            register_name(reg), machine.name, machine.texture_units - 1));
}

Wanted show_register(CombinerProgram& program, const ShownRegister& shown, PixelFormat format) {
    if (shown.reg == Register::color_sum || shown.reg == Register::final_product) {
        // Only the final combiner knows them; neither is negative.
        FinalCombiner& f = program.final_combiner;
        const FinalCombiner nothing;
        f.a = f.b = f.c = nothing.a;
        f.d = {shown.reg, Mapping::unsigned_identity, Component::rgb};
        f.g = nothing.g;
        return {};
    }
    if (shown.stages < program.stages.size()) program.stages.resize(shown.stages);
    return {.reg = shown.reg, .coded = format != PixelFormat::rgba32f};
}

}  // namespace burnish
