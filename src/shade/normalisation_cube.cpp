#include "shade/normalisation_cube.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

namespace burnish {

namespace {

/// The direction whose coordinates on the face are (a, b), -1 .. 1, b downward: the inverse of
/// CubeFaceCtx.
glm::dvec3 direction(int face, double a, double b) {
    switch (face) {
        case 0:
            return {1.0, -b, -a};
        case 1:
            return {-1.0, -b, a};
        case 2:
            return {a, 1.0, b};
        case 3:
            return {a, -1.0, -b};
        case 4:
            return {a, -b, 1.0};
        default:
            return {-a, -b, -1.0};
    }
}

/// Codes 0 .. last of -1 .. 1: 8 and 16 bits as vectors in colours, 9 as a sign and 8 bits.
struct Code {
    int number, last;
};
Code code(double x, int bits) {
    if (bits == 9) return {static_cast<int>(std::floor(255.0 * x + 0.5)) + 255, 510};
    const int last = (1 << bits) - 1;
    const double half = 0.5 * last;
    return {std::clamp(static_cast<int>(std::floor(half * x + half + 0.5)), 0, last), last};
}

/// Faces whose channels hold number / last, to nearest, `one` being 1.
template <class Image, class Channel>
TexturePtr make(int size, int bits, int one, const TextureDescription& description) {
    std::vector<Image> faces;
    for (int face = 0; face < 6; ++face) {
        Image& image = faces.emplace_back(size, size);
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const glm::dvec3 d = direction(face, (2 * x + 1) / static_cast<double>(size) - 1.0,
                                               (2 * y + 1) / static_cast<double>(size) - 1.0);
                const glm::dvec3 unit = d / std::sqrt(glm::dot(d, d));
                Channel* texel = image.at(x, y);
                for (int c = 0; c < 3; ++c) {
                    const Code coded = code(unit[c], bits);
                    const std::int64_t scaled = std::int64_t{coded.number} * one;
                    texel[c] = static_cast<Channel>((scaled + coded.last / 2) / coded.last);
                }
                texel[3] = static_cast<Channel>(one);
            }
        }
    }
    return std::make_shared<Texture>(std::span<const Image>(faces), description);
}

}  // namespace

TexturePtr normalisation_cube(int size, int bits) {
    TextureDescription description{.target = TextureTarget::cube};
    if (bits == 8) return make<Image8, std::uint8_t>(size, bits, 255, description);
    description.format = TexelFormat::rgba16;
    return make<Image16, std::uint16_t>(size, bits, 65535, description);
}

TexturePtr HalfVectorCube::of(const Machine& machine) {
    if (machine.half_vector != HalfVector::cube) return nullptr;
    if (m_size != machine.half_vector_size || m_bits != machine.half_vector_bits) {
        m_size = machine.half_vector_size;
        m_bits = machine.half_vector_bits;
        m_cube = normalisation_cube(m_size, m_bits);
    }
    return m_cube;
}

}  // namespace burnish
