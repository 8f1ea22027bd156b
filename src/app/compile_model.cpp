#include "app/compile_model.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <burnish/materials.hpp>
#include <utility>

#include "app/progress.hpp"
#include "app/verbs.hpp"

namespace burnish::app {
namespace {

/// The profile, with as many passes as a model takes.
Machine machine_of(std::string_view profile) {
    Machine machine = machine_profile(profile);
    machine.multipass = true;
    return machine;
}

/// White light and no ambient light: the constants of the program are the material's.
CompiledModel compiled_for(const Material& material, std::string_view profile) {
    return compile_model(material, machine_of(profile), glm::vec3(1.0F), glm::vec3(0.0F));
}

/// What `profile` makes of the material; how it is refused without what the table says anyway.
ProfileVerdict verdict_of(const Material& material, std::string_view profile) {
    ProfileVerdict verdict{profile, {}, 0};
    try {
        verdict.passes = pass_count(compiled_for(material, profile));
    } catch (const Error& error) {
        verdict.complaint = error.what();
        const std::string machine = fmt::format(" on '{}': ", profile);
        const std::size_t at = verdict.complaint.find(machine);
        if (at != std::string::npos) verdict.complaint.erase(0, at + machine.size());
    }
    return verdict;
}

Material material_of(const CompileModelOptions& options) {
    Material material = options.material.empty() ? Material{} : load_material(options.material);
    if (material.program)
        throw Error(ErrorCode::bad_input,
                    fmt::format("{}: material '{}' is a pipeline, expected one with a reflectance "
                                "model",
                                options.material.string(), material.name));
    material.model = options.model.value_or(material.model);
    return material;
}

}  // namespace

int pass_count(const CompiledModel& compiled) {
    return compiled.passes.empty() ? 1 : static_cast<int>(compiled.passes.size());
}

int map_count(const ModelNeeds& needs) {
    return needs.units - needs.tables - (needs.third_vector ? 1 : 0);
}

std::vector<std::string> registers_left(const ProgramPass& pass) {
    const FinalCombiner& keep = pass.program.final_combiner;
    std::vector<std::string> left;
    for (const Input* input : {&keep.d, &keep.g}) {
        if (input->reg == Register::zero) continue;
        const char* component = input->component == Component::rgb     ? "rgb"
                                : input->component == Component::alpha ? "a"
                                                                       : "b";
        left.push_back(fmt::format("{}.{}", register_name(input->reg), component));
    }
    return left;
}

std::vector<std::string> units_read(const ProgramPass& pass) {
    std::vector<std::string> read;
    for (std::size_t i = 0; i < pass.units.size(); ++i) {
        const PassUnit& unit = pass.units[i];
        if (unit.frame >= 0) {
            read.push_back(fmt::format("tex{} = the frame of pass {}", i, unit.frame + 1));
        } else if (unit.address >= 0) {
            read.push_back(
                fmt::format("tex{} = unit {} at tex{}", i, unit.material_unit, unit.address));
        } else if (unit.material_unit >= 0) {
            read.push_back(fmt::format("tex{} = unit {}", i, unit.material_unit));
        }
    }
    return read;
}

void run(const CompileModelOptions& options) {
    Progress progress(false);
    ModelReport report;
    report.material = material_of(options);
    report.material_file = options.material.string();
    report.model = report.material.model == Model::text
                       ? "model_text"
                       : std::string(model_name(report.material.model));
    report.machine = options.machine;
    try {
        report.compiled = compiled_for(report.material, options.machine);
        report.estimate = estimate_error(report.material, machine_of(options.machine));
    } catch (const Error& error) {
        if (report.material_file.empty()) throw;
        throw Error(error.code(), fmt::format("{}: {}", report.material_file, error.what()));
    }
    for (const std::string_view profile : machine_profile_names()) {
        if (machine_profile(profile).double_precision) continue;  // runs no programs
        report.profiles.push_back(profile == options.machine
                                      ? ProfileVerdict{profile, {}, pass_count(report.compiled)}
                                      : verdict_of(report.material, profile));
    }
    progress.finish();
    fmt::print("{}", options.json ? model_report_json(report) + "\n" : model_report_text(report));
}

}  // namespace burnish::app
