#pragma once

namespace burnish {

/// Linear between a (weight 0) and b (weight 1).
inline double mix(double a, double b, double weight) {
    return a + (b - a) * weight;
}

}  // namespace burnish
