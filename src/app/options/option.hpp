#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "app/command_line.hpp"

/// What each verb of the command accepts, as plain data. The parser, --help, the manual page and
/// the shells' completions are made of it.
namespace burnish::app {

/// Takes one value of an option; throws Error{bad_option} if it is none.
/// @param option  how messages call it, such as "--size"
using Set = std::function<void(const std::string& option, const std::string& text)>;

struct Option {
    /// "-o,--output"; or an argument's name, without dashes: "INPUT".
    std::string names;
    std::string value{};   ///< what stands for the value, "WxH"; empty: a flag, or an argument
    std::string text{};    ///< what it does, without a full stop
    std::string normal{};  ///< the value without the option, if worth telling
    std::vector<std::string_view> words{};  ///< the values there are; empty: any
    bool open_words = false;                ///< `words` only begin values, or are some of a list
    std::string_view files{};  ///< values are files: "toml obj"; "*" any file, "/" directories
    bool required = false;
    bool repeated = false;   ///< may be given several times
    char separator = '\0';   ///< between several values in one word, if not '\0'
    std::string needs{};     ///< an option that must be given as well
    std::string excludes{};  ///< an option that must not
    Set set{};               ///< called for each value once all words are read

    /// "-o" and "--output"
    [[nodiscard]] std::vector<std::string> all_names() const;
    /// How messages call it: by its long name; an argument by its name in small letters.
    [[nodiscard]] std::string label() const;
    /// Whether what a shell completes may go on: "cube:", "rmse=".
    [[nodiscard]] bool goes_on() const;
    /// Extensions in `files`.
    [[nodiscard]] std::vector<std::string> extensions() const;
    [[nodiscard]] bool is_argument() const { return names.front() != '-'; }
    [[nodiscard]] bool is_flag() const { return value.empty() && !is_argument(); }
};

struct OptionGroup {
    std::string title;
    std::vector<Option> options;
};

/// A command line to paste, from the top of the source tree where it names meshes/...
struct Example {
    std::string text;
    std::string line;
};

struct Verb {
    std::string name;
    std::string text;
    std::vector<OptionGroup> groups{};
    std::vector<Verb> verbs{};  ///< of "bake": each has options, it has none
    std::vector<Example> examples{};
    /// What to do once every option is set. Throws Error{bad_option} where something is missing.
    std::function<Command()> command{};
};

/// The verbs from "burnish" to one of its own: burnish, bake, mesh.
using VerbPath = std::vector<const Verb*>;

/// "burnish bake mesh"
std::string whole_name(const VerbPath& path);

/// Every verb that has options of its own, in the order of --help.
std::vector<VerbPath> working_verbs(const Verb& root);

}  // namespace burnish::app
