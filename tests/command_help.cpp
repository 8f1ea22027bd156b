// What the command says about itself: help and its examples.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/files.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tiny_experiment_files.hpp"

namespace burnish {
namespace {

/// Those without verbs of their own.
constexpr std::array kVerbs{"render",
                            "view",
                            "trace",
                            "bake brushed",
                            "bake material",
                            "bake mips",
                            "bake anisotropy",
                            "bake mesh",
                            "bench",
                            "compare",
                            "compile",
                            "experiment",
                            "info",
                            "completion",
                            "man"};

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

class CommandHelp : public TinyExperiment {
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

    /// Whether `line` needs one of the two programs that read manual pages, and that is not there.
    static bool missing_program(const std::string& line) {
        for (const std::string name : {"man", "groff"}) {
            if (line.find("| " + name) != std::string::npos &&
                std::system(("command -v " + name + " >/dev/null").c_str()) != 0)
                return true;
        }
        return false;
    }

    /// The files that examples name, but for pictures, which take the command to be made.
    void prepare() {
        std::filesystem::create_symlink(BURNISH_SOURCE_DIR "/meshes", path("meshes"));
        write(path("program.rc"), "!!RC1.0\nout.rgb = tex0;\n");
        write(path("shader.ts"), "!!TS1.0\ntexture_2d();\n");
        write_scene("ball.toml");
        write_tiny_experiment();
    }
};

TEST_F(CommandHelp, EveryVerbHasGroupsDefaultsAndFourExamples) {
    const std::vector<std::string> verbs = working_verbs();
    EXPECT_TRUE(std::is_permutation(verbs.begin(), verbs.end(), kVerbs.begin(), kVerbs.end()));
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

/// The examples of a verb, or of the command itself.
class CommandExamples : public CommandHelp, public testing::WithParamInterface<const char*> {};

// A verb each, since most of their time (0.2 s a command) is the loading of image libraries: so
// they run side by side.
TEST_P(CommandExamples, RunAsPasted) {
    const std::string verb = GetParam();
    if (verb == "view") GTEST_SKIP() << "a window";
    prepare();
    std::filesystem::create_directory(path("bin"));
    std::filesystem::create_symlink(BURNISH_COMMAND, path("bin/burnish"));
    const std::string text = help(verb);
    if (text.find("reference.png") != std::string::npos) {
        ASSERT_EQ(run("render ball.toml -o reference.png").code, 0);
        ASSERT_EQ(run("render ball.toml --machine nv2a --multipass -o picture.png").code, 0);
    }
    for (const std::string& line : entries_below(text, "Examples")) {
        if (line.starts_with('#') || missing_program(line)) continue;
        write(path("pasted"), "cd \"$HOME\"\n" + line + "\n");
        const std::string shell = "HOME='" + directory().string() + "' PATH='" +
                                  directory().string() + "/bin':\"$PATH\" bash -o pipefail '" +
                                  path("pasted").string() + "' >'" + path("log").string() +
                                  "' 2>&1";
        EXPECT_EQ(std::system(shell.c_str()), 0) << line << '\n' << read(path("log"));
#ifdef BURNISH_SANITIZED
        break;  // one of each verb
#endif
    }
}

std::string verb_name(const testing::TestParamInfo<const char*>& info) {
    std::string name = info.param;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name.empty() ? "burnish" : name;
}
INSTANTIATE_TEST_SUITE_P(Verb, CommandExamples, testing::ValuesIn(kVerbs), verb_name);
INSTANTIATE_TEST_SUITE_P(All, CommandExamples, testing::Values(""), verb_name);

TEST_F(CommandHelp, TheManualHasEveryVerbAndOption) {
    const std::string page = run("man").out;
    for (const char* section : {"NAME", "SYNOPSIS", "DESCRIPTION", "COMMANDS", "EXIT STATUS",
                                "ENVIRONMENT", "FILES", "SEE ALSO"})
        EXPECT_SAYS(page, std::string("\n.SH ") + section + "\n");
    for (const std::string& verb : working_verbs()) {
        EXPECT_SAYS(page, "\n.SS burnish " + verb + "\n");
        for (const std::string& line : lines_of(help(verb))) {
            const std::size_t at = line.find("--");
            if (at != 6 || !line.starts_with("  ")) continue;
            std::string name = "\\fB";  // where the page has it: in bold, with minus signs
            for (const char c : line.substr(at, line.find_first_of(" \n", at) - at))
                name += c == '-' ? std::string("\\-") : std::string(1, c);
            if (name == "\\fB\\-\\-help") continue;
            EXPECT_SAYS(page, name + "\\fR");
        }
    }
    EXPECT_SAYS(page, "BURNISH_ISA");
}

TEST_F(CommandHelp, GroffLikesTheManual) {
    if (std::system("command -v groff >/dev/null") != 0) GTEST_SKIP() << "no groff";
    write(path("burnish.1"), run("man").out);
    const std::string line = "groff -ww -man -Tutf8 '" + path("burnish.1").string() + "' >'" +
                             path("page").string() + "' 2>'" + path("said").string() + "'";
    EXPECT_EQ(std::system(line.c_str()), 0);
    EXPECT_EQ(read(path("said")), "");
    EXPECT_SAYS(read(path("page")), "meshes/brushed.toml");
}

TEST_F(CommandHelp, MisspeltWordsAreRecognised) {
    write_scene("ball.toml");
    const std::string render = "render ball.toml ";
    expect_failure("experimnt e1 -o x", 2, "did you mean 'experiment'?");
    expect_failure("--versoin", 2, "did you mean '--version'?");
    expect_failure("bake --hlp", 2, "did you mean '--help'?");
    expect_failure("bake mips --sett lathe -o x", 2, "did you mean '--set'?");
    expect_failure("info --frobnicate", 2, "unknown option '--frobnicate', `burnish info --help`");
    expect_failure("bake mesh -o x.ply --frobnicate", 2, "`burnish bake mesh --help` lists them");
    expect_failure(render + "--machine ideel", 2, "did you mean 'ideal'?");
    expect_failure(render + "--isa refrence", 2, "did you mean 'reference'?");
    expect_failure(render + "--stats jsn", 2, "did you mean 'json'?");
    expect_failure(render + "--aov norml", 2, "did you mean 'normal'?");
    expect_failure(render + "--half-vector vertx", 2, "did you mean 'vertex'?");
    expect_failure(render + "--filter-order befor", 2, "did you mean 'before'?");
    expect_failure(render + "--mipmaps momnts:8", 2, "did you mean 'moments'?");
    expect_failure("trace ball.toml --by-stage --rounding nearst", 2, "did you mean 'nearest'?");
    expect_failure("trace ball.toml --by-stage --bits combinrs=9", 2, "did you mean 'combiners'?");
    expect_failure("bake mips --set lath -o x", 2, "did you mean 'lathe'?");
    expect_failure("bake mips --set lathe --method toksvg -o x", 2, "did you mean 'toksvig'?");
    expect_failure("compare a.png b.png --mask coverd", 2, "did you mean 'covered'?");
    expect_failure("compare a.png b.png --encoding sgrb", 2, "did you mean 'srgb'?");
    expect_failure("experiment e7_ege -o x", 2, "did you mean 'e7_edge'?");
}

// One by the command, the others here: it loads the libraries of images every time.
TEST_F(CommandHelp, MisspeltFilesAreRecognised) {
    write_scene("ball.toml");
    for (const char* name : {"knot.obj", "picture.png", "program.rc", "a.png"})
        write(path(name), "");
    std::filesystem::create_directory(path("sub"));
    write(path("sub/steel.toml"), "");
    write(path("with.toml"), "schema = 1\n[[objects]]\nmesh = \"knott.obj\"\n");
    expect_failure("render bal.toml", 3,
                   "bal.toml: No such file or directory, did you mean 'ball.toml'?");
    const auto mesh = [&](const char* name) {
        return complaint_of([&] { scene_for_mesh(path(name)); });
    };
    EXPECT_SAYS(mesh("knto.obj"), "did you mean 'knot.obj'?");
    EXPECT_SAYS(mesh("knot.ob"), "did you mean 'knot.obj'?");
    const auto picture = [&](const char* name) {
        return complaint_of([&] { load_frame(path(name)); });
    };
    EXPECT_SAYS(picture("pictures.png"), "did you mean 'picture.png'?");
    expect_failure("compile progam.rc", 3, "did you mean 'program.rc'?");
    expect_failure("compile --material sub/steal.toml", 3, "did you mean 'sub/steel.toml'?");
    const std::string inside = complaint_of([&] { load_scene(path("with.toml")); });
    EXPECT_SAYS(inside, "with.toml:3: ");
    EXPECT_SAYS(inside, "did you mean 'knot.obj'?");
    // Neither near nor there, and a letter that is another file.
    for (const char* name : {"b.png", "else.png", "nowhere/picture.png"})
        EXPECT_EQ(picture(name).find("did you mean"), std::string::npos) << picture(name);
}

}  // namespace
}  // namespace burnish
