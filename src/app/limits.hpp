#pragma once

#include <burnish/framebuffer.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "core/parallel.hpp"
#include "metrics/metrics.hpp"

/// Whether pictures keep the limits that --threshold and --reference-threshold set.
namespace burnish::app {

/// `measured` with the metrics of `limits` and that of pixels that are no numbers, each once and in
/// the order of the enumeration.
metrics::CompareOptions with_limits(metrics::CompareOptions measured,
                                    const std::vector<Threshold>& limits);

/// Throws Error{bad_input} for pictures of two sizes.
void require_one_size(const std::filesystem::path& test_path, const Framebuffer& test,
                      const std::filesystem::path& reference_path, const Framebuffer& reference);

/// Throws Error{bad_input} if nothing could be compared.
void require_pixels(const metrics::Comparison& comparison, const std::filesystem::path& reference);

/// A line for each limit that `comparison` breaks. Pixels that are no numbers break a comparison
/// with limits that does not allow them.
std::vector<std::string> failures(const std::filesystem::path& test, std::vector<Threshold> limits,
                                  const metrics::Comparison& comparison);

/// The same of the image file `test`, beside `reference`.
std::vector<std::string> failures(const std::filesystem::path& test,
                                  const std::filesystem::path& reference_path,
                                  const Framebuffer& reference,
                                  const std::vector<Threshold>& limits, WorkerPool& pool);

}  // namespace burnish::app
