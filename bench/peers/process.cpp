#include "bench/peers/process.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <sstream>
#include <stdexcept>

extern char** environ;

namespace burnish::peers {

namespace {

struct Finished {
    bool succeeded;
    std::string output;
};

Finished run(const std::vector<std::string>& arguments) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addclose(&actions, ends[1]);
    std::vector<char*> argv;
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    pid_t child = 0;
    const int failed = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    std::string output;
    std::array<char, 4096> part{};
    for (ssize_t n = 0; failed == 0 && (n = read(ends[0], part.data(), part.size())) > 0;)
        output.append(part.data(), static_cast<std::size_t>(n));
    close(ends[0]);
    int status = 0;
    if (failed != 0 || waitpid(child, &status, 0) != child) return {false, {}};
    return {WIFEXITED(status) && WEXITSTATUS(status) == 0, output};
}

}  // namespace

std::vector<std::string> output_of(const std::vector<std::string>& arguments) {
    const Finished finished = run(arguments);
    if (!finished.succeeded)
        throw std::runtime_error(fmt::format("failed: {}", fmt::join(arguments, " ")));
    std::vector<std::string> lines;
    std::istringstream stream(finished.output);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

bool succeeds(const std::vector<std::string>& arguments) {
    return run(arguments).succeeded;
}

}  // namespace burnish::peers
