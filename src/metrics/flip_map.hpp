#pragma once

#include <burnish/framebuffer.hpp>
#include <functional>
#include <glm/glm.hpp>

#include "core/parallel.hpp"
#include "metrics/plane.hpp"

namespace burnish::metrics {

/// Makes light of 0 .. 1 of a pixel's numbers.
using ToLinear = std::function<glm::dvec3(const glm::dvec3&)>;

/// FLIP of every pixel after `to_linear`, which is called from the workers of `pool`.
Plane flip_map(const Framebuffer& test, const Framebuffer& reference, double pixels_per_degree,
               const ToLinear& to_linear, WorkerPool& pool);

}  // namespace burnish::metrics
