#pragma once

#include <burnish/scene.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "machine/bind.hpp"
#include "shade/sample.hpp"

namespace burnish {

/// What the texture units hand to the program, known before it is bound: bit i is unit i's.
/// Throws Error{bad_program} for a texture shader that `machine` cannot run.
UnitStates unit_states(const ProgramMaterial& material, const Machine& machine);

/// Units with coordinates of their own; further ones take the first's.
inline constexpr int kCoordinateSets = 4;

/// Attribute plane of component 0 .. 3 (s, t, r, q) of a unit's coordinates; -1 where it is that of
/// (0, 0, 0, 1) everywhere.
using CoordinatePlane = std::function<int(int unit, int component)>;

/// The map whose texels are shaded one by one where the filter comes after the program.
struct FinestMap {
    const Texture* texture;
    int set;  ///< of ProgramMaterial::uv: the coordinates
};

/// Of the flat maps with a linear filter that units fetch at the coordinates of vertices: the one
/// with most texels, the first of equals. On a mesh these are its uv. Tables of fetches between
/// stages do not count.
std::optional<FinestMap> finest_map(const ProgramMaterial& material, const Machine& machine,
                                    bool is_mesh);

/// Where a unit's texel is, before any dimming.
struct PlannedUnit {
    int unit;
    std::size_t first_op;  ///< its operations reach to the next unit's first
    int registers = -1;    ///< first of four register planes, or -1
    int values = -1;       ///< first of two attribute planes of a HILO texel, or -1
};

/// Planes that nobody has taken yet.
struct FreePlanes {
    int attribute;  ///< the first free attribute plane
    int reg;        ///< the first free register plane
};

/// How the units get their results.
struct UnitPlan {
    std::vector<InputOp> ops;
    std::vector<PlannedUnit> units;
    int keep_attribute = -1;   ///< > 0 where the fragment lives, or -1: everywhere
    int depth_attribute = -1;  ///< the fragment's own window depth, or -1
    bool quads = false;        ///< texels with mipmaps at coordinates that no triangle knows
};

/// Operations for every unit that `program` or a later unit reads.
UnitPlan plan_texture_units(const ProgramMaterial& material, const Machine& machine,
                            const BoundProgram& program, const CoordinatePlane& coordinates,
                            SamplePlan& sampling, FreePlanes& free);

/// Operations that bring what `fetch` asks for. Throws Error{bad_program} where the texture has
/// another target.
std::vector<InputOp> plan_stage_fetch(const BoundFetch& fetch, const Texture& texture,
                                      SamplePlan& sampling, FreePlanes& free);

}  // namespace burnish
