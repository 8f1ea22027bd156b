#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace burnish {

/// The output of a shell command, without its last line break; empty if it fails.
inline std::string output_of(const std::string& command) {
    std::FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
    if (pipe == nullptr) return {};
    std::string text;
    std::array<char, 256> part;
    while (std::fgets(part.data(), part.size(), pipe) != nullptr) text += part.data();
    pclose(pipe);
    while (text.ends_with('\n')) text.pop_back();
    return text;
}

/// An X server without a screen, for as long as the object lives.
class VirtualDisplay {
  public:
    VirtualDisplay() {
        int ends[2];
        if (output_of("command -v Xvfb").empty() || pipe(ends) != 0) return;
        m_server = fork();
        if (m_server == 0) {
            close(ends[0]);
            const std::string number = std::to_string(ends[1]);
            execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "800x600x24",
                   "-nolisten", "tcp", "-noreset", static_cast<char*>(nullptr));
            _exit(127);
        }
        close(ends[1]);
        char byte = 0;
        while (read(ends[0], &byte, 1) == 1 && byte != '\n') m_name += byte;
        close(ends[0]);
        if (m_name.empty()) return;
        m_name.insert(0, ":");
        setenv("DISPLAY", m_name.c_str(), 1);
        setenv("SDL_VIDEODRIVER", "x11", 1);
    }
    ~VirtualDisplay() {
        if (m_server <= 0) return;
        kill(m_server, SIGTERM);
        waitpid(m_server, nullptr, 0);
    }
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;

    /// ":99"; empty where no server could be started.
    [[nodiscard]] const std::string& name() const { return m_name; }

  private:
    pid_t m_server = -1;
    std::string m_name;
};

}  // namespace burnish
