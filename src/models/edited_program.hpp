#pragma once

#include <burnish/machine.hpp>
#include <burnish/scene.hpp>

namespace burnish {

/// Puts the object's edited program, if it has one, in place of that of `compiled`, which its model
/// is compiled to on `machine`. A constant of the edited program that EditedProgram::own has in the
/// same place, or else in any stage, becomes the one that `compiled` has there, so that it follows
/// material and light; other constants stay as they were edited.
/// @param light  number of the scene's light that it is compiled for
/// Throws Error{bad_program} where `compiled` is not EditedProgram::own but for constants.
void apply_edit(const Object& object, const Machine& machine, std::size_t light,
                ProgramMaterial& compiled);

}  // namespace burnish
