// What the command says about itself: help and its examples.
#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/run_command.hpp"

namespace burnish {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// Lines below "TITLE:" that begin with two blanks and no more, without them.
std::vector<std::string> entries_below(const std::string& help, const std::string& title) {
    std::vector<std::string> found;
    bool below = false;
    for (const std::string& line : lines_of(help)) {
        if (!line.starts_with(' ')) below = line == title + ":";
        if (below && line.starts_with("  ") && !line.starts_with("   "))
            found.push_back(line.substr(2));
    }
    return found;
}

class CommandHelp : public Command {
  protected:
    std::string help(const std::string& verb) {
        const Result result = run(verb + " --help");
        EXPECT_EQ(result.code, 0) << verb;
        EXPECT_EQ(result.err, "") << verb;
        return result.out;
    }

    /// "render", "bake mesh", ...: verbs without verbs of their own.
    std::vector<std::string> working_verbs(const std::string& above = "") {
        std::vector<std::string> verbs;
        for (const std::string& entry : entries_below(help(above), "Commands")) {
            const std::string verb =
                (above.empty() ? "" : above + " ") + entry.substr(0, entry.find(' '));
            const std::vector<std::string> below = working_verbs(verb);
            if (below.empty()) verbs.push_back(verb);
            verbs.insert(verbs.end(), below.begin(), below.end());
        }
        return verbs;
    }

    /// The files that examples name.
    void prepare() {
        std::filesystem::create_symlink(BURNISH_SOURCE_DIR "/meshes", path("meshes"));
        write(path("program.rc"), "!!RC1.0\nout.rgb = tex0;\n");
        write(path("shader.ts"), "!!TS1.0\ntexture_2d();\n");
        write_scene("ball.toml");
        ASSERT_EQ(run("render ball.toml -o reference.png").code, 0);
        ASSERT_EQ(run("render ball.toml --machine nv2a --multipass -o picture.png").code, 0);
        write(path("tiny.toml"), R"(schema = 1
title = "Tiny"
hypothesis = "A machine is not exact."
metrics = ["rmse"]
[[scenes]]
name = "ball"
file = "ball.toml"
[[sweeps]]
name = "machine"
key = "machine.profile"
values = ["nv2a", "ideal"]
[reference]
samples = 1
set = { "machine.profile" = "double" }
[[expect]]
text = "nine bits are worse"
metric = "rmse"
measure = "ratio"
where = { machine = "nv2a" }
versus = { machine = "ideal" }
at_least = 1
)");
    }
};

TEST_F(CommandHelp, EveryVerbHasGroupsDefaultsAndFourExamples) {
    const std::vector<std::string> verbs = working_verbs();
    EXPECT_GE(verbs.size(), 12U);
    for (const std::string& verb : verbs) {
        const std::string text = help(verb);
        EXPECT_SAYS(text, "\nUsage: burnish " + verb + " [OPTION...]");
        EXPECT_SAYS(text, "\nExit codes: 0 done, 1 ");
        EXPECT_EQ(text.find("\nOptions:"), std::string::npos) << "a group without a name\n" << text;
        int commands = 0;
        for (const std::string& line : entries_below(text, "Examples"))
            commands += line.starts_with('#') ? 0 : 1;
        EXPECT_EQ(commands, 4) << verb;
        bool pasted = false;  // examples stay on one line
        for (const std::string& line : lines_of(text)) {
            pasted = pasted || line == "Examples:";
            EXPECT_TRUE(pasted || line.size() <= 80) << line;
        }
    }
    EXPECT_SAYS(help("bench"), "(default: 50)");
    EXPECT_SAYS(help("bake mesh"), "(default: 64)");
    EXPECT_SAYS(help("compile"), "(default: ideal)");
    EXPECT_SAYS(help("compare"), "(default: 67.02)");
    EXPECT_SAYS(help("bake material"), "(required)");
}

/// All but those of `view`, which opens a window.
TEST_F(CommandHelp, ExamplesRunAsPasted) {
    prepare();
    std::filesystem::create_directory(path("bin"));
    std::filesystem::create_symlink(BURNISH_COMMAND, path("bin/burnish"));
    std::vector<std::string> verbs = working_verbs();
    std::erase(verbs, "view");
    verbs.emplace_back();
    [[maybe_unused]] std::string last = "none";
    for (const std::string& verb : verbs) {
        for (const std::string& line : entries_below(help(verb), "Examples")) {
            if (line.starts_with('#')) continue;
#ifdef BURNISH_SANITIZED
            if (std::exchange(last, verb) == verb) continue;  // one of each verb
#endif
            const std::string pasted = "cd '" + directory().string() +
                                       "' && PATH=\"$PWD/bin:$PATH\" && { " + line +
                                       "; } >'log' 2>&1";
            EXPECT_EQ(std::system(pasted.c_str()), 0) << line << '\n' << read(path("log"));
        }
    }
}

}  // namespace
}  // namespace burnish
