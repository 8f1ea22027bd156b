#include "app/options/help.hpp"

#include <fmt/format.h>

namespace burnish::app {
namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kIndent = 28;  // of what options do

/// `text` in lines of at most kWidth columns, all but the first indented.
std::string wrapped(const std::string& text, std::size_t indent) {
    std::string lines;
    std::size_t column = indent;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::size_t length = end - at;
        if (at > 0 && column + 1 + length > kWidth) {
            lines += '\n' + std::string(indent, ' ');
            column = indent;
        } else if (at > 0) {
            lines += ' ';
            ++column;
        }
        lines += text.substr(at, length);
        column += length;
        at = end + 1;
    }
    return lines;
}

/// "  left   text", the text on a line of its own where `left` is long.
std::string entry(const std::string& left, const std::string& text, std::size_t indent) {
    std::string line = "  " + left;
    if (line.size() + 2 > indent)
        line += '\n' + std::string(indent, ' ');
    else
        line.resize(indent, ' ');
    return line + wrapped(text, indent) + '\n';
}

std::string described(const Option& option) {
    std::string text = option.text;
    if (!option.normal.empty()) text += fmt::format(" (default: {})", option.normal);
    if (option.required && !option.is_argument()) text += " (required)";
    return text;
}

std::string entry(const Option& option) {
    std::string left = fmt::format("{}", fmt::join(option.all_names(), ", "));
    if (!left.starts_with('-') || left.starts_with("--")) {
        if (!option.is_argument()) left = "    " + left;
    }
    if (!option.value.empty()) left += " " + option.value;
    return entry(left, described(option), kIndent);
}

std::string commands(const Verb& verb) {
    std::string text = "\nCommands:\n";
    for (const Verb& part : verb.verbs) text += entry(part.name, part.text, 14);
    return text;
}

std::string examples(const Verb& verb) {
    std::string text = "\nExamples:\n";
    for (const Example& example : verb.examples)
        text += fmt::format("  # {}\n  {}\n", example.text, example.line);
    return text;
}

}  // namespace

std::string usage(const VerbPath& path) {
    const Verb& verb = *path.back();
    std::string text = whole_name(path) + (verb.verbs.empty() ? " [OPTION...]" : " COMMAND");
    for (const OptionGroup& group : verb.groups) {
        for (const Option& option : group.options) {
            if (!option.is_argument() && !option.required) continue;
            std::string word = option.is_argument()
                                   ? option.names
                                   : option.all_names().front() + " " + option.value;
            if (option.repeated) word += "...";
            text += option.required ? " " + word : " [" + word + "]";
        }
    }
    return text;
}

std::string help(const VerbPath& path) {
    const Verb& verb = *path.back();
    std::string text = fmt::format("{}\n\nUsage: {}\n", wrapped(verb.text, 0), usage(path));
    if (!verb.verbs.empty()) text += commands(verb);
    for (const OptionGroup& group : verb.groups) {
        text += fmt::format("\n{}:\n", group.title);
        for (const Option& option : group.options) text += entry(option);
    }
    text += "\nOther:\n" + entry("-h, --help", "Print this text", kIndent);
    if (path.size() == 1) text += entry("    --version", "Print the version", kIndent);
    if (!verb.examples.empty()) text += examples(verb);
    if (!verb.verbs.empty())
        text += fmt::format("\n`{} COMMAND --help` tells more.", whole_name(path));
    return text +
           "\nExit codes: 0 done, 1 a comparison failed, 2 wrong usage, 3 bad input or I/O.\n";
}

}  // namespace burnish::app
