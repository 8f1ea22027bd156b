#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace burnish::reference {

/// Where a pixel is looked at: its centre, or one place in every cell of a grid of side x side,
/// moved about by a hash of seed, pixel and sample. So it depends on nothing else.
class SamplePattern {
  public:
    explicit SamplePattern(int side, std::uint32_t seed = 1) : m_side(side), m_seed(seed) {}

    [[nodiscard]] int count() const { return m_side * m_side; }
    /// Samples along each side of a pixel.
    [[nodiscard]] int side() const { return m_side; }

    /// Sample 0 .. count() - 1 of pixel (x, y), in pixels; centres are at .5.
    [[nodiscard]] glm::dvec2 position(int x, int y, int sample) const {
        if (m_side == 1) return {x + 0.5, y + 0.5};
        const std::uint64_t bits = hash(x, y, sample);
        const double across = static_cast<double>(bits >> 32) * 0x1p-32;
        const double down = static_cast<double>(bits & 0xffffffffU) * 0x1p-32;
        return {x + (sample % m_side + across) / m_side, y + (sample / m_side + down) / m_side};
    }

  private:
    /// Three rounds of multiplying and folding; the constants are those of SplitMix64.
    [[nodiscard]] std::uint64_t hash(int x, int y, int sample) const {
        std::uint64_t h = m_seed;
        for (const int key : {x, y, sample}) {
            h = (h ^ static_cast<std::uint32_t>(key)) + 0x9e3779b97f4a7c15U;
            h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9U;
            h = (h ^ h >> 27) * 0x94d049bb133111ebU;
            h ^= h >> 31;
        }
        return h;
    }

    int m_side;
    std::uint32_t m_seed;
};

}  // namespace burnish::reference
