#pragma once

#include "app/command_line.hpp"

/// The commands. Each does its work, prints its results to standard output and notes to standard
/// error, and throws Error for whatever goes wrong.
namespace burnish::app {

void run(const PrintText& text);
void run(const RenderOptions& options);
void run(const TraceOptions& options);
void run(const BenchOptions& options);
void run(const InfoOptions& options);
void run(const BakeBrushedOptions& options);
void run(const BakeMeshOptions& options);

}  // namespace burnish::app
