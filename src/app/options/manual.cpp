#include "app/options/manual.hpp"

#include <fmt/format.h>

#include <map>
#include <vector>

#include "app/options/help.hpp"
#include "app/options/verbs.hpp"

namespace burnish::app {
namespace {

/// As it is, whatever groff makes of its characters; hyphens to be typed are minus signs.
std::string in_roff(std::string_view text) {
    std::string result;
    if (text.starts_with('.') || text.starts_with('\'')) result = "\\&";
    for (const char c : text) {
        switch (c) {
            case '\\':
                result += "\\e";
                break;
            case '-':
                result += "\\-";
                break;
            case '\'':
                result += "\\(aq";
                break;
            case '`':
                result += "\\(ga";
                break;
            case '~':
                result += "\\(ti";
                break;
            case '^':
                result += "\\(ha";
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::string bold(std::string_view text) {
    return "\\fB" + in_roff(text) + "\\fR";
}

std::string option_entry(const Option& option) {
    std::string left;
    for (const std::string& name : option.all_names())
        left += (left.empty() ? "" : ", ") + bold(name);
    if (!option.value.empty()) left += " \\fI" + in_roff(option.value) + "\\fR";
    std::string text = fmt::format(".TP\n{}\n{}.\n", left, in_roff(option.text));
    if (!option.normal.empty()) text += fmt::format("Default: {}.\n", in_roff(option.normal));
    if (option.required && !option.is_argument()) text += "Required.\n";
    return text;
}

/// What tells whether two groups are the same.
std::string signature(const OptionGroup& group) {
    std::string names = group.title;
    for (const Option& option : group.options) names += " " + option.names;
    return names;
}

/// Groups that another verb has, too, are described once.
class Verbs {
  public:
    std::string section(const VerbPath& path) {
        const Verb& verb = *path.back();
        std::string text = fmt::format(".SS {}\n{}.\n.PP\n.nh\n{}\n.hy\n", whole_name(path),
                                       in_roff(verb.text), bold(usage(path)));
        std::map<std::string, std::vector<std::string>> elsewhere;
        for (const OptionGroup& group : verb.groups) {
            const auto [known, first] = m_described.emplace(signature(group), whole_name(path));
            if (first || group.options.size() < 3)
                text += group_text(group);
            else
                elsewhere[known->second].push_back(group.title);
        }
        for (const auto& [name, titles] : elsewhere)
            text += fmt::format(".PP\nAs of {}: the options under {}.\n", bold(name),
                                in_roff(fmt::format("{}", fmt::join(titles, ", "))));
        text += ".PP\nExamples:\n";
        for (const Example& example : verb.examples)
            text += fmt::format(".PP\n{}:\n.PP\n.RS 4\n.nf\n{}\n.fi\n.RE\n", in_roff(example.text),
                                in_roff(example.line));
        return text;
    }

  private:
    static std::string group_text(const OptionGroup& group) {
        std::string text = fmt::format(".PP\n\\fI{}\\fR\n", in_roff(group.title));
        for (const Option& option : group.options) text += option_entry(option);
        return text;
    }

    std::map<std::string, std::string> m_described;
};

std::string term(std::string_view name, std::string_view text) {
    return fmt::format(".TP\n{}\n{}\n", bold(name), in_roff(text));
}

std::string exit_codes() {
    return ".SH EXIT STATUS\n" + term("0", "Done.") + term("1", "A comparison or check failed.") +
           term("2", "Wrong usage: an option, a word or a combination that there is not.") +
           term("3", "Bad input, or a file that cannot be read or written.") +
           ".PP\nErrors are one line on standard error:\n" + bold("burnish: FILE:LINE: ") +
           "what was found, what was expected.\nAn output file appears whole or not at all.\n";
}

std::string environment() {
    return ".SH ENVIRONMENT\n" +
           term("BURNISH_ISA",
                "Instruction set of the kernels where --isa does not say: avx512, avx2, sse42, "
                "neon64 or reference. The picture is the same with each.");
}

std::string files() {
    return ".SH FILES\n" +
           term("*.toml",
                "A scene, a material or an experiment; docs/scenes.md, "
                "docs/materials.md and docs/experiments.md say what stands in them.") +
           term("*.obj, *.ply, *.off, *.stl",
                "Meshes. One without a scene gets a camera that sees all of it, one light and "
                "brushed steel.") +
           term("*.rc, *.ts", "Combiner programs and texture shaders; docs/programs.md.") +
           term("*.png, *.exr",
                "Pictures, and whatever else OpenImageIO writes. EXR holds "
                "numbers as they are.");
}

}  // namespace

std::string manual_page(const Verb& root) {
    std::string text = fmt::format(
        ".\\\" Made by `burnish man`, from the text of `burnish --help`.\n"
        ".TH BURNISH 1 \"\" \"burnish {0}\" \"User commands\"\n.ad l\n"
        ".SH NAME\nburnish \\- software rasterizer with an emulated register\\-combiner machine\n"
        ".SH SYNOPSIS\n\\fBburnish\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR...]\n.br\n"
        "\\fBburnish\\fR [\\fICOMMAND\\fR] \\fB\\-\\-help\\fR\n.br\n"
        "\\fBburnish \\-\\-version\\fR\n"
        ".SH DESCRIPTION\n{1}.\n.SH COMMANDS\n",
        BURNISH_VERSION, in_roff(root.text));
    Verbs verbs;
    for (const VerbPath& path : working_verbs(root)) text += verbs.section(path);
    return text + exit_codes() + environment() + files() + ".SH SEE ALSO\n.BR gnuplot (1)\n";
}

Verb man_verb() {
    return {.name = "man",
            .text = "Prints the manual page burnish(1)",
            .examples = {{"The page, formatted", "burnish man | man -l -"},
                         {"The same without man", "burnish man | groff -man -Tutf8"},
                         {"Where the user's pages lie",
                          "mkdir -p ~/.local/share/man/man1 && burnish man > "
                          "~/.local/share/man/man1/burnish.1"},
                         {"Its sections", "burnish man | grep '^.S[HS]'"}},
            .command = [] { return PrintText{manual_page(burnish_command())}; }};
}

}  // namespace burnish::app
