#include <fmt/format.h>

#include <vector>

#include "app/options/completion.hpp"

namespace burnish::app {
namespace {

constexpr const char kHead[] = R"(# bash completion for burnish, made by `burnish completion bash`

# The words that begin with what was typed; of a list with commas its last word counts.
_burnish_words() {
    local list='' last=$word
    if [[ $1 == , && $word == *,* ]]; then
        list=${word%,*},
        last=${word##*,}
    fi
    shift
    local found
    while IFS= read -r found; do COMPREPLY+=("$list$found"); done < <(compgen -W "$*" -- "$last")
}

# Directories, and files with one of the extensions; all files without any.
_burnish_files() {
    local name extension
    compopt -o filenames 2>/dev/null
    while IFS= read -r name; do
        if [[ -d ${name/#\~/$HOME} || $# -eq 0 ]]; then
            COMPREPLY+=("$name")
            continue
        fi
        for extension; do
            if [[ ${name,,} == *."$extension" ]]; then COMPREPLY+=("$name"); fi
        done
    done < <(compgen -f -- "$word")
}

_burnish() {
    local word=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD-1]} verb='' i
    COMPREPLY=()
    # bash makes words of --option=value's parts.
    if [[ $word == '=' ]]; then
        word=''
    elif [[ $option == '=' ]]; then
        option=${COMP_WORDS[COMP_CWORD-2]}
    fi
    for ((i = 1; i < COMP_CWORD && i < 3; i++)); do
        if [[ ${COMP_WORDS[i]} != -* ]]; then verb+=${verb:+ }${COMP_WORDS[i]}; fi
        case $verb in
)";

constexpr const char kTail[] = R"(    esac
}
complete -F _burnish burnish
)";

std::string in_quotes(std::string_view word) {
    return fmt::format("'{}'", word);
}

/// Shell commands that complete a value of `option`; empty if nothing is known of it.
std::string completed(const Option& option) {
    std::vector<std::string> commands;
    if (!option.words.empty()) {
        const std::string mark = option.separator == ',' ? "," : "''";
        if (option.goes_on()) commands.emplace_back("compopt -o nospace 2>/dev/null");
        commands.push_back(fmt::format("_burnish_words {} {}", mark, fmt::join(option.words, " ")));
    }
    if (option.files == "/")
        commands.emplace_back("_burnish_files /");  // no name ends so: directories alone
    else if (!option.files.empty())
        commands.push_back(fmt::format("_burnish_files {}", fmt::join(option.extensions(), " ")));
    return fmt::format("{}", fmt::join(commands, "; "));
}

/// One branch of `case $verb`: values of options, else options, else arguments.
std::string branch(const std::string& verb, const std::vector<OptionGroup>& groups) {
    std::string values;
    std::string arguments;
    std::string names = "-h --help";
    for (const OptionGroup& group : groups) {
        for (const Option& option : group.options) {
            if (option.is_argument()) {
                const std::string words = completed(option);
                if (arguments.find(words) == std::string::npos)
                    arguments += (arguments.empty() ? "" : "; ") + words;
                continue;
            }
            names += fmt::format(" {}", fmt::join(option.all_names(), " "));
            if (option.is_flag()) continue;
            const std::string words = completed(option);
            values +=
                fmt::format("            {}) {}{}return ;;\n", fmt::join(option.all_names(), "|"),
                            words, words.empty() ? "" : "; ");
        }
    }
    std::string text = fmt::format("    {})\n", in_quotes(verb));
    if (!values.empty()) text += "        case $option in\n" + values + "        esac\n";
    text +=
        fmt::format("        if [[ $word == -* ]]; then _burnish_words '' {}; return; fi\n", names);
    if (!arguments.empty()) text += "        " + arguments + "\n";
    return text + "        ;;\n";
}

/// Branches of the verbs that have verbs.
std::string verb_branches(const VerbPath& path, const std::string& name) {
    const std::vector<Verb>& verbs = path.back()->verbs;
    if (verbs.empty()) return {};
    std::string names;
    std::string text;
    for (const Verb& verb : verbs) names += " " + verb.name;
    for (const Verb& verb : verbs) {
        VerbPath longer = path;
        longer.push_back(&verb);
        text += verb_branches(longer, name.empty() ? verb.name : name + " " + verb.name);
    }
    return fmt::format("    {}) _burnish_words ''{} -h --help{} ;;\n", in_quotes(name), names,
                       name.empty() ? " --version" : "") +
           text;
}

}  // namespace

std::string bash_completion(const Verb& root) {
    std::string text = kHead;
    std::string working;
    std::string branches = verb_branches({&root}, "");
    for (const VerbPath& path : working_verbs(root)) {
        const std::string name = whole_name(path).substr(root.name.size() + 1);
        working += fmt::format("{}{}", working.empty() ? "" : "|", in_quotes(name));
        branches += branch(name, path.back()->groups);
    }
    text += fmt::format("            {}) break ;;\n        esac\n    done\n    case $verb in\n",
                        working);
    return text + branches + kTail;
}

}  // namespace burnish::app
