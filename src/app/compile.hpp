#pragma once

#include <burnish/combiner.hpp>
#include <burnish/texture_shader.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What `burnish compile` has found out, as text for people and for programs.
namespace burnish::app {

struct ProfileVerdict {
    std::string_view profile;
    std::string complaint;  ///< why the machine cannot run the programs; empty if it can
    int passes = 1;         ///< that it takes with `multipass`; 0 where that does not help
};

struct Compiled {
    std::string combiners_file;
    CombinerProgram combiners;
    std::string texture_shader_file;
    std::optional<TextureShader> texture_shader;
    std::vector<ProfileVerdict> profiles;
};

/// Tables of every stage, the final combiner, constants, texture units and profiles.
std::string compiled_text(const Compiled& compiled);
/// One object, one line; inputs as print_input writes them.
std::string compiled_json(const Compiled& compiled);

/// The "combiners" of that object; without a file for an empty name.
std::string combiners_json(const CombinerProgram& program, const std::string& file);
/// The "texture_shader", likewise.
std::string texture_shader_json(const std::optional<TextureShader>& shader,
                                const std::string& file);
/// The "profiles".
std::string profiles_json(const std::vector<ProfileVerdict>& profiles);

/// The header of the oldest language that can say it, without the exclamation marks.
std::string language_of(const CombinerProgram& program);

}  // namespace burnish::app
