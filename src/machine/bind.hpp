#pragma once

#include <array>
#include <burnish/combiner.hpp>
#include <burnish/machine.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "kernels/kernel_table.hpp"

namespace burnish {

inline constexpr int kRegisterCount = static_cast<int>(Register::discard) + 1;

/// A texture fetch between portions: coordinates are the numbers of register planes, see
/// Reading::unsigned_texel and, where `expand` says so, Reading::expanded.
struct BoundFetch {
    std::size_t before = 0;  ///< the portion in front of which it runs, or how many there are
    int unit = 0;            ///< whose texture is read
    FetchTarget target = FetchTarget::table_2d;
    std::array<int, 3> plane{};  ///< the first coordinate_count(target) count
    std::array<bool, 3> expand{};
    int out = 0;            ///< first of four planes that get the texel
    std::uint8_t live = 0;  ///< bit c: channel c is wanted
};

/// A combiner program as a list of block operations on register planes.
///
/// Every value of the program has a plane of its own from the operation that writes it to the last
/// one that reads it; so both portions of a stage read what was there before the stage, and no
/// kernel writes a plane that it reads. Results that nothing reads are not computed, and a result
/// that is the same in r, g and b is computed once.
struct BoundProgram {
    NumberModel numbers = NumberModel::wide;
    /// Codes of planes 0 .. constants.size() - 1, the same in every fragment.
    std::vector<std::int16_t> constants;
    int plane_count = 0;
    /// Plane that must hold component c of register r before the first operation, -1 where the
    /// program never reads it: input[r][c]. The planes of a texture register are four in a row,
    /// whichever of them are read.
    std::array<std::array<int, 4>, kRegisterCount> input;
    std::vector<PortionCtx> portions;
    std::vector<BoundFetch> fetches;  ///< in the order in which they run
    bool has_final = true;            ///< else the result lies in registers already
    FinalCtx final_combiner{};
    std::array<std::int16_t, 4> result{};  ///< planes of r, g, b, a

    [[nodiscard]] bool reads(Register r) const;
};

/// What texture units hand to a program; bit i is unit i's.
struct UnitStates {
    std::uint32_t enabled = 0;  ///< delivers texels
    std::uint32_t black = 0;    ///< not enabled and reads (0, 0, 0, 0); else it reads (0, 0, 0, 1)
    std::uint32_t textured =
        0;  ///< fetches between stages find a texture; others bring (0, 0, 0, 1)
    std::uint32_t bounded = 0;    ///< its texels lie within [-1, 1],
    std::uint32_t positive = 0;   ///< within [0, 1]
    bool bounded_colors = false;  ///< col0 and col1 do, too
};

/// What is wanted of a program; the inputs that it asks for follow from that.
struct Wanted {
    bool everything = false;  ///< also results that nothing reads
    /// This register after the last general stage instead of the final combiner's result.
    std::optional<Register> reg = {};
    bool coded = false;  ///< the register as x/2 + 1/2, 0 .. 1, for frames without signs
};

/// Throws Error{bad_program} for what `machine` cannot run.
BoundProgram bind(const CombinerProgram& program, const Machine& machine, const UnitStates& units,
                  const Wanted& wanted = {});

/// Fills the constant planes of a packet; needed once per packet memory and program.
void load_constants(const BoundProgram& program, Packet& packet);

/// Runs portions first .. last - 1.
void run_portions(const BoundProgram& program, const KernelTable& kernels, Packet& packet,
                  std::size_t first, std::size_t last);

/// Runs the final combiner if it is asked for.
void run_final(const BoundProgram& program, const KernelTable& kernels, Packet& packet);

/// Runs a program without fetches.
void run(const BoundProgram& program, const KernelTable& kernels, Packet& packet);

}  // namespace burnish
