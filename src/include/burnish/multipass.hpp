#pragma once

#include <burnish/combiner.hpp>
#include <burnish/machine.hpp>
#include <cstdint>
#include <span>
#include <vector>

/// Programs that need more than a machine has, as several passes over the picture: a pass leaves a
/// register's values in an 8-bit frame, a later one reads them back as a texture, texel by pixel.
/// What can be split, and what cannot: docs/programs.md, "Several passes".
namespace burnish {

/// What a texture unit of a material delivers.
enum class UnitTexels : std::uint8_t {
    none,             ///< disabled: (0, 0, 0, 1)
    unsigned_texels,  ///< 0 .. 1
    signed_texels,    ///< -1 .. 1
};

/// One unit of a pass: a unit of the material, a frame, a table, or nothing.
struct PassUnit {
    int material_unit = -1;
    int frame = -1;  ///< of that pass
    int address =
        -1;  ///< of a table: the unit of this pass, a frame, whose alpha is s and red is t

    friend bool operator==(const PassUnit&, const PassUnit&) = default;
};

/// All but the last pass leave a frame whose rgb and alpha are a register's each.
struct ProgramPass {
    CombinerProgram program;      ///< valid for the machine
    std::vector<PassUnit> units;  ///< at most as many as the machine has
};

/// The machine with as many general stages, texture units and constants as a program may ask for,
/// and, if its texture units have dependent reads, with fetches between stages.
Machine with_room(const Machine& machine);

/// The passes, in order, that give on `machine` what `program` gives on with_room(machine): the
/// same bits. A program that fits is one pass.
/// @param units  the material's; more than `machine` has are welcome
/// @param fixed  units keep their numbers, as those of a texture shader must
/// A fetch between stages becomes a dependent read: one pass leaves its coordinates in a frame,
/// later ones read the frame and, with its alpha and red, the table. Throws Error{bad_program} with
/// the first obstacle where there is no such split: values that an 8-bit frame cannot hold
/// (negative ones, wide registers), no unit left to read them with, coordinates that a frame cannot
/// bring to alpha and red.
std::vector<ProgramPass> split_into_passes(const CombinerProgram& program, const Machine& machine,
                                           std::span<const UnitTexels> units, bool fixed = false);

}  // namespace burnish
