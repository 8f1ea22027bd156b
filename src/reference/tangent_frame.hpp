#pragma once

#include <array>
#include <burnish/machine.hpp>
#include <glm/glm.hpp>

#include "reference/double_scene.hpp"

namespace burnish::reference {

/// Axes at a point of a surface; object space.
struct TangentFrame {
    glm::dvec3 t, b, n;

    [[nodiscard]] glm::dvec3 components(const glm::dvec3& x) const {
        return {glm::dot(t, x), glm::dot(b, x), glm::dot(n, x)};
    }
};

/// x / |x|; zero stays zero.
glm::dvec3 normalised(const glm::dvec3& x);

/// A triangle's corners at some weight of the three.
struct SurfacePoint {
    std::array<const DoubleVertex*, 3> corner;
    glm::dvec3 weight;

    template <class Value>
    [[nodiscard]] Value mean(Value DoubleVertex::*of) const {
        return corner[0]->*of * weight.x + corner[1]->*of * weight.y + corner[2]->*of * weight.z;
    }
};

/// Tangent, bitangent and normal as `kind` has it. Triangles whose uv have no area have their
/// vertices' axes under TangentFrames::derivative, too.
TangentFrame tangent_frame(const SurfacePoint& point, TangentFrames kind);

}  // namespace burnish::reference
