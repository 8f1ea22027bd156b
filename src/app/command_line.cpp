// The one file that sees CLI11, which takes seconds to compile. What verbs accept stands in
// app/options.
#include "app/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <burnish/error.hpp>
#include <cctype>

#include "app/options/verbs.hpp"
#include "app/options/words.hpp"
#include "core/nearest.hpp"

namespace burnish::app {
namespace {

[[noreturn]] void fail(const std::string& message) {
    throw Error(ErrorCode::bad_option, message);
}

/// How messages call an option: by its long name; an argument by its name in small letters.
std::string label(const Option& option) {
    if (!option.is_argument()) return option.names.substr(option.names.find(',') + 1);
    std::string name = option.names;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    return name;
}

/// Hands all values of an option over to it.
CLI::callback_t taker(const Option& option) {
    return [&option](const CLI::results_t& values) {
        for (const std::string& value : values) {
            if (!option.words.empty() && !option.open_words)
                known_word(label(option), value, option.words);
            option.set(label(option), value);
        }
        return true;
    };
}

CLI::Option* add_option(CLI::App& app, const Option& option) {
    if (option.is_flag()) {
        const auto take = [&option] { option.set(option.names, ""); };
        return app.add_flag_callback(option.names, take, option.text)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    }
    CLI::Option* added = app.add_option(option.names, taker(option), option.text);
    added->type_name(option.value)->required(option.required);
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
            all.back().second->group(group.title);
        }
    }
    for (const auto& [option, added] : all) {
        if (!option->needs.empty()) added->needs(app.get_option(option->needs));
        if (!option->excludes.empty()) added->excludes(app.get_option(option->excludes));
    }
    if (!verb.verbs.empty()) app.require_subcommand(1);
    for (const Verb& part : verb.verbs) add_verb(*app.add_subcommand(part.name, part.text), part);
}

/// The verb that was given last: "mesh" of "bake mesh".
const Verb& chosen_verb(const CLI::App& app, const Verb& verb) {
    for (const CLI::App* given : app.get_subcommands())
        for (const Verb& part : verb.verbs)
            if (part.name == given->get_name()) return chosen_verb(*given, part);
    return verb;
}

std::vector<std::string_view> verb_names(const CLI::App& app) {
    std::vector<std::string_view> names;
    for (const CLI::App* verb : app.get_subcommands({})) names.emplace_back(verb->get_name());
    return names;
}

/// CLI11 speaks of unexpected arguments; for a misspelt command, say what commands there are.
const CLI::App& require_known_verbs(const CLI::App& root, int argc, const char* const* argv) {
    const CLI::App* app = &root;
    for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
        const std::vector<std::string_view> names = verb_names(*app);
        if (names.empty()) break;
        if (std::find(names.begin(), names.end(), argv[i]) == names.end())
            fail(fmt::format("unknown command '{}', {}", argv[i], expected_one_of(argv[i], names)));
        app = app->get_subcommand(argv[i]);
    }
    return *app;
}

/// "burnish bake mesh"
std::string whole_name(const CLI::App& app) {
    const CLI::App* parent = app.get_parent();
    return parent == nullptr ? app.get_name() : whole_name(*parent) + " " + app.get_name();
}

/// The first option that `verb` does not have, with the one that was probably meant.
void require_known_options(const CLI::App& verb, int argc, const char* const* argv) {
    std::vector<std::string> owned;
    for (const CLI::Option* option : verb.get_options()) {
        for (const std::string& name : option->get_lnames()) owned.push_back("--" + name);
    }
    const std::vector<std::string_view> names(owned.begin(), owned.end());
    for (int i = 1; i < argc; ++i) {
        const std::string_view whole = argv[i];
        const std::string_view word = whole.substr(0, whole.find('='));
        if (word == "--" || !word.starts_with("--")) continue;
        if (std::find(names.begin(), names.end(), word) != names.end()) continue;
        const std::string_view near = nearest_name(word, names);
        fail(near.empty() ? fmt::format("unknown option '{}', `{} --help` lists them", word,
                                        whole_name(verb))
                          : fmt::format("unknown option '{}', did you mean '{}'?", word, near));
    }
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
    const Verb burnish{
        .name = "burnish",
        .text = "burnish renders meshes through an emulated register-combiner machine",
        .verbs = all_verbs()};
    CLI::App app(burnish.text, burnish.name);
    app.set_version_flag("--version", "burnish " BURNISH_VERSION);
    add_verb(app, burnish);
    const CLI::App& verb = require_known_verbs(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return PrintText{verb.help()};
    } catch (const CLI::CallForVersion& version) {
        return PrintText{std::string(version.what()) + "\n"};
    } catch (const CLI::ParseError& error) {
        require_known_options(verb, argc, argv);
        fail(error.what());
    }
    return chosen_verb(app, burnish).command();
}

}  // namespace burnish::app
