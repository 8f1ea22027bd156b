#include <burnish/error.hpp>
#include <burnish/machine.hpp>
#include <memory>

#include "app/options/groups.hpp"
#include "app/options/verbs.hpp"
#include "app/options/words.hpp"

namespace burnish::app {
namespace {

constexpr const char kProgram[] = "FILE.rc";

/// The machines that run programs.
std::vector<std::string_view> program_profiles() {
    std::vector<std::string_view> names = machine_profile_names();
    std::erase_if(names,
                  [](std::string_view name) { return machine_profile(name).double_precision; });
    return names;
}

OptionGroup program_options(CompileOptions& program) {
    return {"A program",
            {{.names = kProgram,
              .text = "Combiners: !!RC1.0 or !!BRN1.0",
              .files = "rc",
              .set = text_to(program.combiners)},
             {.names = "FILE.ts",
              .text = "Texture shader: !!TS1.0",
              .files = "ts",
              .set = text_to(program.texture_shader)}}};
}

OptionGroup model_options(CompileModelOptions& model) {
    return {"Or a reflectance model",
            {{.names = "--model",
              .value = "NAME",
              .text = "Of the default material or of that of --material; `burnish info` lists them",
              .words = model_names(),
              .excludes = kProgram,
              .set = [&model](const std::string&,
                              const std::string& name) { model.model = model_named(name); }},
             {.names = "--material",
              .value = "FILE",
              .text = "Material file (.toml): its parameters, and without --model its model",
              .files = "toml",
              .excludes = kProgram,
              .set = text_to(model.material)},
             {.names = "--machine",
              .value = "PROFILE",
              .text = "What to compile the model for: geforce256, nv2a or ideal",
              .normal = model.machine,
              .words = program_profiles(),
              .excludes = kProgram,
              .set = text_to(model.machine)}}};
}

}  // namespace

Verb compile_verb() {
    const auto program = std::make_shared<CompileOptions>();
    const auto model = std::make_shared<CompileModelOptions>();
    return {.name = "compile",
            .text = "Checks and prints program texts, or the program of a reflectance model",
            .groups = {program_options(*program),
                       model_options(*model),
                       {"Output", {json_option(program->json)}}},
            .examples = {{"Checks a program and prints its stages", "burnish compile program.rc"},
                         {"A program with its texture shader, as JSON",
                          "burnish compile program.rc shader.ts --json"},
                         {"The program of a model on the chip of 1999",
                          "burnish compile --model abp_modified --machine geforce256"},
                         {"What the model of a material needs on the chip of 2001",
                          "burnish compile --material meshes/materials/hair.toml --machine nv2a"}},
            .command = [program, model]() -> Command {
                if (!program->combiners.empty()) return *program;
                model->json = program->json;
                if (model->model || !model->material.empty()) return *model;
                throw Error(ErrorCode::bad_option,
                            "compile: expected FILE.rc, --model NAME or --material FILE");
            }};
}

}  // namespace burnish::app
