#pragma once

#include <burnish/framebuffer.hpp>
#include <functional>
#include <glm/glm.hpp>
#include <span>

#include "core/parallel.hpp"
#include "metrics/plane.hpp"

namespace burnish::metrics {

/// Makes light of 0 .. 1 of a row's numbers, in place.
using ToLinear = std::function<void(std::span<glm::dvec3>)>;

/// FLIP of every pixel after `to_linear`, which is called from the workers of `pool`.
Plane flip_map(const Framebuffer& test, const Framebuffer& reference, double pixels_per_degree,
               const ToLinear& to_linear, WorkerPool& pool);

}  // namespace burnish::metrics
