#include "models/edited_program.hpp"

#include <fmt/format.h>

#include <array>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <burnish/program_text.hpp>
#include <string>

namespace burnish {
namespace {

using Slot = std::optional<glm::vec4> GeneralStage::*;
constexpr std::array<Slot, 2> kSlots{&GeneralStage::const0, &GeneralStage::const1};

/// The text without numbers: what two programs have in common that differ in constants alone.
std::string structure(CombinerProgram program) {
    program.const0 = program.const1 = glm::vec4(0.0F);
    for (GeneralStage& stage : program.stages) {
        for (const Slot slot : kSlots)
            if (stage.*slot) stage.*slot = glm::vec4(0.0F);
    }
    return print_combiners(program);
}

/// What stands in `now` where `own` has `value` as a stage's constant; `value` if it has it
/// nowhere. Both have the same structure.
glm::vec4 current(const glm::vec4& value, std::size_t stage, Slot slot, const CombinerProgram& own,
                  const CombinerProgram& now) {
    if (stage < own.stages.size() && own.stages[stage].*slot == value)
        return *(now.stages[stage].*slot);
    for (std::size_t other = 0; other < own.stages.size(); ++other) {
        for (const Slot each : kSlots)
            if (own.stages[other].*each == value) return *(now.stages[other].*each);
    }
    return value;
}

CombinerProgram with_current_constants(const EditedProgram& edited, const CombinerProgram& now) {
    CombinerProgram program = edited.program;
    if (program.const0 == edited.own.const0) program.const0 = now.const0;
    if (program.const1 == edited.own.const1) program.const1 = now.const1;
    for (std::size_t i = 0; i < program.stages.size(); ++i) {
        for (const Slot slot : kSlots) {
            std::optional<glm::vec4>& constant = program.stages[i].*slot;
            if (constant) constant = current(*constant, i, slot, edited.own, now);
        }
    }
    return program;
}

}  // namespace

void apply_edit(const Object& object, const Machine& machine, std::size_t light,
                ProgramMaterial& compiled) {
    if (!object.edited) return;
    if (structure(object.edited->own) != structure(compiled.combiners)) {
        const Material& material = object.material ? *object.material : Material{};
        throw Error(ErrorCode::bad_program,
                    fmt::format("material '{}': the edited program was made of another one than "
                                "{} is compiled to on '{}'{}",
                                material.name, model_name(material.model), machine.name,
                                light == 0 ? "" : fmt::format(" in light {}", light + 1)));
    }
    compiled.combiners = with_current_constants(*object.edited, compiled.combiners);
}

}  // namespace burnish
