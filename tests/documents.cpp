// What the documents tell a newcomer to type.
#include <fmt/format.h>

#include "tests/run_command.hpp"

namespace burnish {
namespace {

/// Texts between "```LANGUAGE" and "```".
std::vector<std::string> fences(const std::string& text, const std::string& language) {
    std::vector<std::string> found;
    const std::string begin = "\n```" + language + "\n";
    for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
        at += begin.size();
        found.push_back(text.substr(at, text.find("\n```", at) + 1 - at));
    }
    return found;
}

class Documents : public Command {
  protected:
    static std::string document(const std::string& name) {
        return read(std::filesystem::path(BURNISH_SOURCE_DIR) / name);
    }

    /// Runs `script` in the directory, with the command in the PATH; what it prints goes to "log".
    int paste(const std::string& script) {
        std::filesystem::create_directories(path("build/release/bin"));
        std::error_code there;
        std::filesystem::create_symlink(BURNISH_COMMAND, path("build/release/bin/burnish"), there);
        write(path("script"), script);
        const std::string line = fmt::format(
            "cd '{0}' && PATH='{0}/build/release/bin':\"$PATH\" bash -e script > log 2>&1",
            directory().string());
        return std::system(line.c_str());
    }
};

TEST_F(Documents, TutorialRunsFromTopToBottom) {
    const std::vector<std::string> blocks = fences(document("docs/tutorial.md"), "sh");
    EXPECT_GE(blocks.size(), 9U);
    for (const std::string& block : blocks)
        ASSERT_EQ(paste(block), 0) << block << '\n' << read(path("log"));
    for (const char* file : {"copper.png", "nv2a.png", "scratched.png", "moments.png", "scene.png"})
        EXPECT_TRUE(std::filesystem::exists(path(file))) << file;
}

/// In a clean tree, as far as a test inside of one can: `./run demo` and `./run test` themselves
/// are what builds the tree and runs this.
TEST_F(Documents, ReadmeRunsFromTopToBottom) {
    const std::vector<std::string> blocks = fences(document("README.md"), "sh");
    ASSERT_EQ(blocks.size(), 2U);
    const std::string help = "cd '" BURNISH_SOURCE_DIR "' && ./run help";
    ASSERT_EQ(paste(help), 0);
    const std::string commands = read(path("log"));
    for (const char* name : {"demo", "test"}) {
        EXPECT_SAYS(blocks[0], std::string("./run ") + name + " ");
        EXPECT_SAYS(commands, std::string("\n  ") + name + " ");
    }
    std::filesystem::create_symlink(BURNISH_SOURCE_DIR "/meshes", path("meshes"));
    ASSERT_EQ(paste(blocks[1]), 0) << read(path("log"));
    EXPECT_TRUE(std::filesystem::exists(path("picture.png")));
    EXPECT_TRUE(std::filesystem::exists(path("knot.exr")));
}

}  // namespace
}  // namespace burnish
