#include "metrics/flip_color.hpp"

#include <cmath>

namespace burnish::metrics {
namespace {

// Of linear sRGB to CIE XYZ and the white point, as in the authors' program (FLIP.h, BSD-3-Clause),
// which has them from image-engineering.de's technical note 958. Columns of GLM are red, green,
// blue.
const glm::dmat3 kXyzFromRgb(10135552.0 / 24577794.0, 2613072.0 / 12288897.0,
                             1425312.0 / 73733382.0,  //
                             8788810.0 / 24577794.0, 8788810.0 / 12288897.0,
                             8788810.0 / 73733382.0,  //
                             4435075.0 / 24577794.0, 887015.0 / 12288897.0,
                             70074185.0 / 73733382.0);
const glm::dvec3 kWhite(0.950428545, 1.0, 1.088900371);

/// 116 Y - 16, 500 (X - Y), 200 (Y - Z), all over the white's: less the constant.
const glm::dmat3 kOpponentFromXyz = glm::dmat3(0.0, 500.0, 0.0,       //
                                               116.0, -500.0, 200.0,  //
                                               0.0, 0.0, -200.0) *
                                    glm::dmat3(1.0 / kWhite.x, 0.0, 0.0,  //
                                               0.0, 1.0 / kWhite.y, 0.0,  //
                                               0.0, 0.0, 1.0 / kWhite.z);
const glm::dvec3 kOffset(-16.0, 0.0, 0.0);
const glm::dmat3 kOpponentFromRgb = kOpponentFromXyz * kXyzFromRgb;
const glm::dmat3 kRgbFromOpponent = glm::inverse(kOpponentFromRgb);

/// CIE 15:2004: a cube root with a straight line below (6 / 29)^3.
double lab_curve(double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

}  // namespace

double srgb_to_linear(double value) {
    return value > 0.04045 ? std::pow((value + 0.055) / 1.055, 2.4) : value / 12.92;
}

glm::dvec3 opponent_from_linear(const glm::dvec3& rgb) {
    return kOpponentFromRgb * rgb + kOffset;
}

glm::dvec3 linear_from_opponent(const glm::dvec3& ycxcz) {
    return kRgbFromOpponent * (ycxcz - kOffset);
}

glm::dvec3 hunt_lab_from_linear(const glm::dvec3& rgb) {
    const glm::dvec3 xyz = kXyzFromRgb * rgb / kWhite;
    const glm::dvec3 t(lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z));
    const double lightness = 116.0 * t.y - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (t.x - t.y),
            0.01 * lightness * 200.0 * (t.y - t.z)};
}

double hyab(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 d = a - b;
    return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

}  // namespace burnish::metrics
