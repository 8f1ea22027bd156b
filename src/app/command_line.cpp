// The one file that sees CLI11, which takes seconds to compile. What verbs accept stands in
// app/options.
#include "app/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <burnish/error.hpp>

#include "app/options/help.hpp"
#include "app/options/verbs.hpp"
#include "app/options/words.hpp"
#include "core/nearest.hpp"

namespace burnish::app {
namespace {

[[noreturn]] void fail(const std::string& message) {
    throw Error(ErrorCode::bad_option, message);
}

/// What `error` says, with the word that `text` was probably meant to be.
Error with_near_word(const Error& error, const std::string& text, const Option& option) {
    const std::string said = error.what();
    const std::string_view near = nearest_name(text, option.words);
    if (near.empty() || near == text || said.find("did you mean") != std::string::npos)
        return error;
    return {error.code(), fmt::format("{}, did you mean '{}'?", said, near)};
}

/// Hands all values of an option over to it.
CLI::callback_t taker(const Option& option) {
    return [&option](const CLI::results_t& values) {
        for (const std::string& value : values) {
            if (!option.words.empty() && !option.open_words)
                known_word(option.label(), value, option.words);
            try {
                option.set(option.label(), value);
            } catch (const Error& error) {
                throw with_near_word(error, value, option);
            }
        }
        return true;
    };
}

CLI::Option* add_option(CLI::App& app, const Option& option) {
    if (option.is_flag()) {
        const auto take = [&option] { option.set(option.names, ""); };
        return app.add_flag_callback(option.names, take)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    }
    CLI::Option* added = app.add_option(option.names, taker(option));
    added->required(option.required);
    if (option.repeated) {
        added->expected(1, CLI::detail::expected_max_vector_size);
        added->allow_extra_args(option.is_argument());
    }
    if (option.separator != '\0') added->delimiter(option.separator);
    return added;
}

/// Adds the options and verbs of `verb`, to which `app` keeps references.
void add_verb(CLI::App& app, const Verb& verb) {
    std::vector<std::pair<const Option*, CLI::Option*>> all;
    for (const OptionGroup& group : verb.groups) {
        for (const Option& option : group.options) {
            all.emplace_back(&option, add_option(app, option));
        }
    }
    for (const auto& [option, added] : all) {
        if (!option->needs.empty()) added->needs(app.get_option(option->needs));
        if (!option->excludes.empty()) added->excludes(app.get_option(option->excludes));
    }
    if (!verb.verbs.empty()) app.require_subcommand(1);
    for (const Verb& part : verb.verbs) add_verb(*app.add_subcommand(part.name), part);
}

/// The verb that the line begins with. CLI11 speaks of unexpected arguments; for a misspelt
/// command, say what commands there are.
VerbPath named_verb(const Verb& root, int argc, const char* const* argv) {
    VerbPath path{&root};
    for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
        const std::vector<Verb>& verbs = path.back()->verbs;
        if (verbs.empty()) break;
        std::vector<std::string_view> names;
        for (const Verb& verb : verbs) names.emplace_back(verb.name);
        const auto found = std::find(names.begin(), names.end(), argv[i]);
        if (found == names.end())
            fail(fmt::format("unknown command '{}', {}", argv[i], expected_one_of(argv[i], names)));
        path.push_back(&verbs[static_cast<std::size_t>(found - names.begin())]);
    }
    return path;
}

/// The first option that the verb does not have, with the one that was probably meant.
void require_known_options(const VerbPath& path, int argc, const char* const* argv) {
    std::vector<std::string> owned{"-h", "--help"};
    if (path.size() == 1) owned.emplace_back("--version");
    for (const OptionGroup& group : path.back()->groups) {
        for (const Option& option : group.options) {
            for (const std::string& name : option.all_names()) owned.push_back(name);
        }
    }
    const std::vector<std::string_view> names(owned.begin(), owned.end());
    for (int i = 1; i < argc; ++i) {
        const std::string_view whole = argv[i];
        const std::string_view word = whole.substr(0, whole.find('='));
        if (word == "--" || !word.starts_with("--")) continue;
        if (std::find(names.begin(), names.end(), word) != names.end()) continue;
        const std::string_view near = nearest_name(word, names);
        fail(near.empty() ? fmt::format("unknown option '{}', `{} --help` lists them", word,
                                        whole_name(path))
                          : fmt::format("unknown option '{}', did you mean '{}'?", word, near));
    }
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
    const Verb burnish = burnish_command();
    CLI::App app("", burnish.name);
    app.set_version_flag("--version", "burnish " BURNISH_VERSION);
    add_verb(app, burnish);
    const VerbPath path = named_verb(burnish, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return PrintText{help(path)};
    } catch (const CLI::CallForVersion& version) {
        return PrintText{std::string(version.what()) + "\n"};
    } catch (const CLI::ParseError& error) {
        require_known_options(path, argc, argv);
        fail(error.what());
    }
    if (!path.back()->command) fail("expected a command, `burnish --help` lists them");
    return path.back()->command();
}

}  // namespace burnish::app
