#include "app/compile.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/multipass.hpp>
#include <burnish/program_text.hpp>
#include <filesystem>

#include "app/verbs.hpp"
#include "core/read_text.hpp"

namespace burnish::app {
namespace {

void add_lines(std::vector<std::string>& lines, const std::filesystem::path& path,
               const std::vector<TextError>& errors) {
    for (const TextError& error : errors)
        lines.push_back(
            fmt::format("{}:{}:{}: {}", path.string(), error.line, error.column, error.message));
}

/// What `profile` says to the programs; empty if it runs them.
std::string complaint(const Compiled& compiled, std::string_view profile) {
    const Machine machine = machine_profile(profile);
    try {
        compiled.combiners.validate(machine);
        if (compiled.texture_shader) compiled.texture_shader->validate(machine);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

/// How many passes `profile` needs; 0 where the programs cannot be split for it. Which units are
/// enabled is the material's business: all of them are taken to deliver colours.
int pass_count(const Compiled& compiled, std::string_view profile) {
    const std::vector<UnitTexels> units(16, UnitTexels::unsigned_texels);
    const Machine machine = machine_profile(profile);
    try {
        if (compiled.texture_shader) compiled.texture_shader->validate(machine);
        const bool fixed = compiled.texture_shader.has_value();
        const auto used = static_cast<std::size_t>(fixed ? kTextureShaderUnits : 16);
        return static_cast<int>(
            split_into_passes(compiled.combiners, machine, std::span(units).first(used), fixed)
                .size());
    } catch (const Error&) {
        return 0;
    }
}

}  // namespace

std::string language_of(const CombinerProgram& program) {
    const std::string text = print_combiners(program);
    return text.substr(2, text.find('\n') - 2);
}

void run(const CompileOptions& options) {
    Parsed<CombinerProgram> combiners = parse_combiners(read_text(options.combiners));
    Parsed<TextureShader> shader;
    if (!options.texture_shader.empty())
        shader = parse_texture_shader(read_text(options.texture_shader));

    std::vector<std::string> lines;
    add_lines(lines, options.combiners, combiners.errors);
    add_lines(lines, options.texture_shader, shader.errors);
    if (!lines.empty()) throw BadInput(std::move(lines));

    Compiled compiled{options.combiners.string(),
                      std::move(*combiners.program),
                      options.texture_shader.string(),
                      shader.program,
                      {}};
    for (const std::string_view profile : machine_profile_names()) {
        if (machine_profile(profile).double_precision) continue;  // runs no programs
        ProfileVerdict& verdict = compiled.profiles.emplace_back();
        verdict.profile = profile;
        verdict.complaint = complaint(compiled, profile);
        if (!verdict.complaint.empty()) verdict.passes = pass_count(compiled, profile);
    }
    fmt::print("{}", options.json ? compiled_json(compiled) + "\n" : compiled_text(compiled));
}

}  // namespace burnish::app
