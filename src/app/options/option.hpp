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

    [[nodiscard]] bool is_argument() const { return names.front() != '-'; }
    [[nodiscard]] bool is_flag() const { return value.empty() && !is_argument(); }
};

struct OptionGroup {
    std::string title;
    std::vector<Option> options;
};

struct Verb {
    std::string name;
    std::string text;
    std::vector<OptionGroup> groups{};
    std::vector<Verb> verbs{};  ///< of "bake": each has options, it has none
    /// What to do once every option is set. Throws Error{bad_option} where something is missing.
    std::function<Command()> command{};
};

}  // namespace burnish::app
