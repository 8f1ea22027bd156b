#pragma once

#include <cstdint>
#include <glm/glm.hpp>

/// Numbers that look random and are the same on every machine.
namespace burnish::generators {

/// Integer hash with full avalanche (the finaliser of MurmurHash3, applied to a running state).
[[nodiscard]] constexpr std::uint32_t mix(std::uint32_t state, std::uint32_t value) {
    std::uint32_t h = state ^ (value * 0xcc9e2d51U);
    h ^= h >> 16;
    h *= 0x85ebca6bU;
    h ^= h >> 13;
    h *= 0xc2b2ae35U;
    return h ^ (h >> 16);
}

/// [0, 1).
[[nodiscard]] constexpr double unit_interval(std::uint32_t h) {
    return h * (1.0 / 4294967296.0);
}

/// A sequence of numbers in [0, 1).
class Random {
  public:
    explicit Random(std::uint32_t seed) : m_seed(seed) {}
    double next() { return unit_interval(mix(m_seed, m_count++)); }
    double between(double low, double high) { return low + (high - low) * next(); }
    /// Two of them, x first: compilers disagree about the order of arguments.
    glm::dvec2 between(const glm::dvec2& low, const glm::dvec2& high) {
        const double x = between(low.x, high.x);
        return {x, between(low.y, high.y)};
    }

  private:
    std::uint32_t m_seed;
    std::uint32_t m_count = 0;
};

}  // namespace burnish::generators
