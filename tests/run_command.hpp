#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/scratch_directory.hpp"

namespace burnish {

/// Runs the real command in a directory of its own.
class Command : public ScratchDirectory {
  protected:
    struct Result {
        int code = -1;
        std::string out;
        std::string err;
    };

    /// `arguments` as the shell reads them; `before` may set variables.
    Result run(const std::string& arguments, const std::string& before = "") {
        const std::filesystem::path logs = directory().string() + ".logs";
        std::filesystem::create_directory(logs);
        const std::string line = "cd '" + directory().string() + "' && " + before +
                                 " '" BURNISH_COMMAND "' " + arguments + " >'" +
                                 (logs / "out").string() + "' 2>'" + (logs / "err").string() + "'";
        const int status = std::system(line.c_str());
        Result result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(logs / "out"),
                      read(logs / "err")};
        std::filesystem::remove_all(logs);
        return result;
    }

    /// Fails with `code`, says one line that begins "burnish: " and holds `part`, leaves nothing.
    void expect_failure(const std::string& arguments, int code, const std::string& part) {
        const std::vector<std::string> before = entries();
        const Result result = run(arguments);
        EXPECT_EQ(result.code, code) << arguments << "\n" << result.err;
        EXPECT_TRUE(result.err.starts_with("burnish: ")) << arguments << "\n" << result.err;
        EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
        EXPECT_SAYS(result.err, part);
        EXPECT_EQ(result.out, "") << arguments;
        EXPECT_EQ(entries(), before) << arguments;
    }

    void write_scene(const std::string& name, const std::string& more = "") {
        write(path(name), R"(schema = 1
[output]
width = 40
height = 30
background = [0.2, 0.4, 0.6, 1.0]
[[lights]]
direction = [0.3, 0.8, 0.5]
[[objects]]
shape = "sphere"
)" + more);
    }
};

}  // namespace burnish
