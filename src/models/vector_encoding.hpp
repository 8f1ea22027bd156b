#pragma once

#include <algorithm>
#include <burnish/scene.hpp>
#include <cmath>

/// Numbers of -1 .. 1 as unsigned codes of 8 or 16 bits; the table stands in docs/materials.md.
/// With H = 128 or 32768, half the number of codes:
///   a  n / (H - 1/2) - 1             all of -1 .. 1, no exact 0
///   b  max((n - H) / (H - 1), -1)    0 and both ends exact, the lowest code repeats -1
///   c  the same, n in two's complement
///   d  (n - H) / H                   0 and -1 exact, 1 out of reach: at most 1 - 1/H
namespace burnish {

/// `bits`: 8 or 16; 0 <= code < 2^bits.
[[nodiscard]] constexpr double decode_vector_code(VectorEncoding encoding, int code, int bits) {
    const int half = 1 << (bits - 1);
    switch (encoding) {
        case VectorEncoding::a:
            return code / (half - 0.5) - 1.0;
        case VectorEncoding::b:
            return std::max(static_cast<double>(code - half) / (half - 1), -1.0);
        case VectorEncoding::c:
            return std::max(static_cast<double>(code < half ? code : code - 2 * half) / (half - 1),
                            -1.0);
        case VectorEncoding::d:
            break;
    }
    return static_cast<double>(code - half) / half;
}

/// The code whose number is nearest to x, of two the larger one; x is clamped to what the encoding
/// reaches.
[[nodiscard]] inline int encode_vector_code(VectorEncoding encoding, double x, int bits) {
    const int half = 1 << (bits - 1);
    x = std::clamp(x, -1.0, 1.0);
    const auto nearest = [](double value) { return static_cast<int>(std::floor(value + 0.5)); };
    switch (encoding) {
        case VectorEncoding::a:
            return nearest((half - 0.5) * (x + 1.0));
        case VectorEncoding::b:
            return half + nearest((half - 1) * x);
        case VectorEncoding::c: {
            const int n = nearest((half - 1) * x);
            return n < 0 ? n + 2 * half : n;
        }
        case VectorEncoding::d:
            break;
    }
    return std::min(half + nearest(half * x), 2 * half - 1);
}

}  // namespace burnish
