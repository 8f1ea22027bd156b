#include "app/compile.hpp"

#include <fmt/format.h>

#include <array>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>
#include <filesystem>
#include <fstream>

#include "app/verbs.hpp"

namespace burnish::app {
namespace {

/// Programs are a few KB; this keeps a wrong file name from filling the memory.
constexpr std::size_t kLargestText = 16 << 20;

std::string read_text(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        throw Error(ErrorCode::io, fmt::format("{}: cannot be opened for reading", path.string()));
    std::string text;
    std::array<char, 1 << 16> chunk;
    do {
        stream.read(chunk.data(), chunk.size());
        text.append(chunk.data(), static_cast<std::size_t>(stream.gcount()));
    } while (stream && text.size() <= kLargestText);
    if (stream.bad()) throw Error(ErrorCode::io, fmt::format("{}: cannot be read", path.string()));
    if (text.size() > kLargestText)
        throw Error(ErrorCode::limit, fmt::format("{}: more than {} MB, expected a program",
                                                  path.string(), kLargestText >> 20));
    return text;
}

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
    for (const std::string_view profile : machine_profile_names())
        compiled.profiles.push_back({profile, complaint(compiled, profile)});
    fmt::print("{}", options.json ? compiled_json(compiled) + "\n" : compiled_text(compiled));
}

}  // namespace burnish::app
