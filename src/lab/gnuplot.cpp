#include "lab/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/read_text.hpp"

namespace burnish::lab {

namespace {

/// A directory of its own for as long as it lives.
class ScratchDirectory {
  public:
    ScratchDirectory() {
        std::string name = (std::filesystem::temp_directory_path() / "burnish-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            throw Error(ErrorCode::io,
                        fmt::format("{}: cannot be made: {}", name, std::strerror(errno)));
        m_path = name;
    }
    ~ScratchDirectory() {
        std::error_code ignored;
        std::filesystem::remove_all(m_path, ignored);
    }
    ScratchDirectory(const ScratchDirectory&) = delete;
    ScratchDirectory& operator=(const ScratchDirectory&) = delete;

    [[nodiscard]] std::filesystem::path file(const char* name) const { return m_path / name; }

  private:
    std::filesystem::path m_path;
};

}  // namespace

std::string gnuplot_text(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return result;
}

std::string run_gnuplot(const std::filesystem::path& script) {
    std::string name = "gnuplot", file = script.string();
    std::array<char*, 3> arguments{name.data(), file.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int failure =
        posix_spawnp(&child, name.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure == ENOENT) return "no plots: gnuplot is not there (Debian package gnuplot-nox)";
    if (failure != 0) return fmt::format("no plots: gnuplot: {}", std::strerror(failure));
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
    return fmt::format("no plots: gnuplot fails on {}", file);
}

std::string svg_by_gnuplot(const std::string& commands, int width, int height) {
    const ScratchDirectory scratch;
    const std::filesystem::path script = scratch.file("script.gnuplot"),
                                svg = scratch.file("plot.svg");
    save_text(fmt::format("set terminal svg size {},{} noenhanced font \"sans,11\" background rgb "
                          "\"white\"\nset output \"{}\"\n{}",
                          width, height, gnuplot_text(svg.string()), commands),
              script);
    const std::string problem = run_gnuplot(script);
    if (!problem.empty()) throw Error(ErrorCode::io, problem);
    return read_text(svg);
}

}  // namespace burnish::lab
