#include <fmt/format.h>

#include <burnish/error.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <variant>

#include "app/command_line.hpp"
#include "app/verbs.hpp"

namespace {

int exit_code(burnish::ErrorCode code) {
    return code == burnish::ErrorCode::bad_option ? 2 : 3;
}

/// One line, whatever a file name in the message contains.
void report(std::string message) {
    for (char& c : message) {
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    }
    fmt::print(stderr, "burnish: {}\n", message);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const burnish::app::Command command = burnish::app::parse_command_line(argc, argv);
        std::visit([](const auto& options) { burnish::app::run(options); }, command);
        // A full disk shows when the last of the output leaves the buffer.
        if (std::fflush(stdout) != 0)
            throw burnish::Error(burnish::ErrorCode::io, "standard output cannot be written");
        return 0;
    } catch (const burnish::app::CheckFailed& check) {
        for (const std::string& line : check.lines) report(line);
        return std::fflush(stdout) == 0 ? 1 : 3;
    } catch (const burnish::app::BadInput& errors) {
        for (const std::string& line : errors.lines) report(line);
        return 3;
    } catch (const burnish::Error& error) {
        report(error.what());
        return exit_code(error.code());
    } catch (const std::bad_alloc&) {
        report("out of memory");
        return 3;
    } catch (const std::exception& error) {
        report(error.what());
        return 3;
    }
}
