#pragma once

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "app/command_line.hpp"

/// The commands. Each does its work, prints its results to standard output and notes to standard
/// error, and throws Error or BadInput for whatever goes wrong.
namespace burnish::app {

/// Bad input that takes several lines to tell, exit code 3.
struct BadInput : std::exception {
    std::vector<std::string> lines;

    explicit BadInput(std::vector<std::string> what) : lines(std::move(what)) {}
    [[nodiscard]] const char* what() const noexcept override { return "bad input"; }
};

/// A comparison or check that came out wrong, told in one line each, exit code 1.
struct CheckFailed : std::exception {
    std::vector<std::string> lines;

    explicit CheckFailed(std::vector<std::string> what) : lines(std::move(what)) {}
    [[nodiscard]] const char* what() const noexcept override { return "check failed"; }
};

void run(const PrintText& text);
void run(const RenderOptions& options);
void run(const ViewOptions& options);
void run(const TraceOptions& options);
void run(const BenchOptions& options);
void run(const CompareOptions& options);
void run(const CompileOptions& options);
void run(const CompileModelOptions& options);
void run(const InfoOptions& options);
void run(const BakeBrushedOptions& options);
void run(const BakeMaterialOptions& options);
void run(const BakeMipsOptions& options);
void run(const BakeAnisotropyOptions& options);
void run(const BakeMeshOptions& options);
void run(const ExperimentOptions& options);

}  // namespace burnish::app
