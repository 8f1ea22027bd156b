#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "app/options/completion.hpp"

namespace burnish::app {
namespace {

/// Within single quotes of zsh, and within the brackets or between the colons of _arguments.
std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '\'') {
            result += "'\\''";
            continue;
        }
        if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
        result += c;
    }
    return result;
}

/// "_burnish_bake_mesh"
std::string function_name(const VerbPath& path) {
    std::string name = "_" + whole_name(path);
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}

/// What _arguments does for a value: words, files, both, or a message.
std::string action(const Option& option) {
    const std::string words = fmt::format("{}", fmt::join(option.words, " "));
    std::string files;
    if (option.files == "/")
        files = "_files -/";
    else if (option.files == "*")
        files = "_files";
    else if (!option.files.empty())
        files = fmt::format("_files -g \"*.({})\"", fmt::join(option.extensions(), "|"));
    if (option.words.empty()) return files.empty() ? " " : files;
    if (option.goes_on()) return fmt::format("{{ compadd -S \"\" -- {} }}", escaped(words));
    if (option.separator == ',') return fmt::format("_values -s , value {}", words);
    if (!files.empty()) return fmt::format("{{ compadd -- {}; {} }}", words, files);
    return fmt::format("({})", words);
}

std::string argument(const Option& option) {
    return fmt::format("    '{}:{}:{}'", option.repeated ? "*" : "", escaped(option.names),
                       action(option));
}

std::string named(const Option& option) {
    const std::vector<std::string> names = option.all_names();
    const std::string value =
        option.is_flag() ? "" : fmt::format(":{}:{}", escaped(option.value), action(option));
    const std::string told = fmt::format("'[{}]{}'", escaped(option.text), value);
    const auto spelt = [&](const std::string& name) {
        if (option.is_flag()) return name;
        return name + (name.starts_with("--") ? "=" : "+");
    };
    if (names.size() == 1)
        return fmt::format("    {}{}{}", option.repeated ? "'*'" : "", spelt(names.front()), told);
    return fmt::format("    '({0} {1})'{{{2},{3}}}{4}", names.front(), names.back(),
                       spelt(names.front()), spelt(names.back()), told);
}

/// A function that completes a verb with options.
std::string working_function(const VerbPath& path) {
    std::string text = function_name(path) + "() {\n  _arguments -S \\\n";
    for (const OptionGroup& group : path.back()->groups)
        for (const Option& option : group.options)
            text += (option.is_argument() ? argument(option) : named(option)) + " \\\n";
    return text + "    '(- *)'{-h,--help}'[Print this text]'\n}\n\n";
}

/// A function that completes a verb with verbs, after theirs.
std::string verbs_function(const VerbPath& path) {
    std::string below;
    std::string list;
    std::string cases;
    for (const Verb& verb : path.back()->verbs) {
        VerbPath longer = path;
        longer.push_back(&verb);
        below += verb.verbs.empty() ? working_function(longer) : verbs_function(longer);
        list += fmt::format("    '{}:{}'\n", verb.name, escaped(verb.text));
        cases += fmt::format("        {}) {} ;;\n", verb.name, function_name(longer));
    }
    return fmt::format(R"({0}{1}() {{
  local state line
  local -a verbs
  verbs=(
{2}  )
  _arguments -C -S '(- *)'{{-h,--help}}'[Print this text]'{4} '1:command:->verb' '*::argument:->rest'
  case $state in
    verb) _describe -t commands command verbs ;;
    rest)
      case $line[1] in
{3}      esac ;;
  esac
}}

)",
                       below, function_name(path), list, cases,
                       path.size() == 1 ? " '(- *)--version[Print the version]'" : "");
}

}  // namespace

std::string zsh_completion(const Verb& root) {
    return "#compdef burnish\n# zsh completion for burnish, made by `burnish completion zsh`\n\n" +
           verbs_function({&root}) +
           // The file is the function's body when it is loaded from $fpath.
           "if [[ $funcstack[1] == _burnish ]]; then\n  _burnish \"$@\"\nelse\n"
           "  compdef _burnish burnish\nfi\n";
}

}  // namespace burnish::app
