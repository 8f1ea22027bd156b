#pragma once

#include <array>
#include <burnish/combiner.hpp>
#include <burnish/machine.hpp>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/quantiser.hpp"

/// The combiner machine for one fragment, straight from the rules and as plain as they are: the
/// oracle for programs that were bound to kernels, and what `burnish trace` shows.
namespace burnish {

/// One value of four components per register. `discard` takes a place but is never written.
template <class Value>
struct Registers {
    std::array<std::array<Value, 4>, static_cast<std::size_t>(Register::discard) + 1> values{};

    std::array<Value, 4>& operator[](Register r) { return values[static_cast<std::size_t>(r)]; }
    const std::array<Value, 4>& operator[](Register r) const {
        return values[static_cast<std::size_t>(r)];
    }
};

/// Red, green, blue, alpha as register codes: value * 255 (nine_bit) or value * 2^14 (wide).
using Codes = std::array<int, 4>;
using RegisterFile = Registers<int>;

/// The same as real numbers.
using Reals = std::array<double, 4>;
using RealRegisters = Registers<double>;

/// Code of a constant or an interpolated colour x: floor(x * one + 1/2) in single precision,
/// clamped to 0 .. one, as the stages encode_nine_bit and encode_wide have it. NaN gives 0.
int color_code(float x, NumberModel numbers);

/// The code of 1: 255 or 16384.
int code_of_one(NumberModel numbers);

/// The texel that a fetch between stages brings, from its coordinates: numbers, not codes. The
/// first coordinate_count(target) count, the others are 0.
using FetchCodes = std::function<Codes(const StageFetch& fetch, const std::array<float, 3>& at)>;
using FetchReals = std::function<Reals(const StageFetch& fetch, const std::array<double, 3>& at)>;

/// What the final combiner delivers, 0 .. 255 or 0 .. 16384.
/// @param program  valid for `machine` (CombinerProgram::validate)
/// @param inputs   col0, col1 and tex0 .. tex15 within the register's range; an unused unit reads
///                 (0, 0, 0, one). The other registers are set here: constants and fog from the
///                 program, spare0.alpha from tex0.alpha, 0 elsewhere.
/// @param trace    gets the registers before the first stage, after each stage (with the constants
///                 of that stage) and as the final combiner saw them, that is with the global
///                 constants, color_sum and final_product; stages + 2 in all.
/// @param fetch    serves the fetches between stages.
/// Throws Error{bad_program} for such fetches if there is no `fetch`.
Codes run_combiners(const CombinerProgram& program, const Machine& machine,
                    const RegisterFile& inputs, std::vector<RegisterFile>* trace = nullptr,
                    const FetchCodes& fetch = nullptr);

/// What rounds the numbers of a program that runs in double precision: the constants that a stage
/// may read, each product and each output; of the final combiner its product, its lerp and what it
/// delivers.
struct CombinerRounding {
    Quantiser* quantiser = nullptr;    ///< null: nothing is rounded
    std::span<const int> stages = {};  ///< bits of each general stage, a sign and the rest
    int final_bits = kExactBits;       ///< without a sign
};

/// The same program in exact arithmetic (double precision): nothing is rounded unless `rounding`
/// says so, 1/2 is 1/2, and values stop where the machine's registers and operands stop.
Reals run_combiners_exactly(const CombinerProgram& program, const Machine& machine,
                            const RealRegisters& inputs,
                            std::vector<RealRegisters>* trace = nullptr,
                            const FetchReals& fetch = nullptr,
                            const CombinerRounding& rounding = {});

}  // namespace burnish
