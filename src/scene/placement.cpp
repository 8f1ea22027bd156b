#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/scene.hpp>
#include <cmath>

#include "core/dmath.hpp"

namespace burnish {
namespace {

struct Vec3d {
    double x, y, z;
};

double length(const Vec3d& v) {
    return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

constexpr double radians(double degrees) {
    return degrees * (dmath::kPi / 180.0);
}

}  // namespace

glm::mat4 placement(const glm::vec3& translate, const glm::vec3& axis, float degrees, float scale) {
    const Vec3d a{axis.x, axis.y, axis.z};
    const double len = length(a);
    if (!(len > 0.0) || !std::isfinite(len))
        throw Error(ErrorCode::bad_option, "rotation axis has no length, expected a direction");
    if (!(scale > 0.0F) || !std::isfinite(scale))
        throw Error(ErrorCode::bad_option,
                    "scale " + std::to_string(scale) + ", expected a positive number");
    // Whole turns are dropped first: dmath's sine is for moderate angles.
    const double angle = radians(std::fmod(static_cast<double>(degrees), 360.0));
    const double c = dmath::cos(angle);
    const double s = dmath::sin(angle);
    const Vec3d u{a.x / len, a.y / len, a.z / len};
    // Rodrigues' rotation, columns of the matrix.
    const double k = 1.0 - c;
    const double m[3][3] = {{c + u.x * u.x * k, u.y * u.x * k + u.z * s, u.z * u.x * k - u.y * s},
                            {u.x * u.y * k - u.z * s, c + u.y * u.y * k, u.z * u.y * k + u.x * s},
                            {u.x * u.z * k + u.y * s, u.y * u.z * k - u.x * s, c + u.z * u.z * k}};
    glm::mat4 result(1.0F);
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row)
            result[column][row] = static_cast<float>(m[column][row] * static_cast<double>(scale));
    }
    result[3] = glm::vec4(translate, 1.0F);
    return result;
}

Camera framing_camera(const Bounds& bounds, float aspect) {
    const Vec3d half{0.5 * (double{bounds.high.x} - double{bounds.low.x}),
                     0.5 * (double{bounds.high.y} - double{bounds.low.y}),
                     0.5 * (double{bounds.high.z} - double{bounds.low.z})};
    const Vec3d center{double{bounds.low.x} + half.x, double{bounds.low.y} + half.y,
                       double{bounds.low.z} + half.z};
    // A point, or an empty box, still gets a camera that looks at it.
    const double diagonal = length(half);
    const double radius = diagonal > 0.0 && std::isfinite(diagonal) ? diagonal : 1.0;

    Camera camera;
    camera.view_angle = 30.0F;
    const double half_vertical = radians(0.5 * static_cast<double>(camera.view_angle));
    const double half_horizontal =
        dmath::atan(dmath::tan(half_vertical) * static_cast<double>(aspect));
    const double distance = 1.02 * radius / dmath::sin(std::min(half_vertical, half_horizontal));
    const Vec3d from{0.5, 0.35, 1.0};
    const double step = distance / length(from);
    camera.focal_point = {center.x, center.y, center.z};
    camera.position = {center.x + from.x * step, center.y + from.y * step,
                       center.z + from.z * step};
    camera.near = static_cast<float>(std::max(distance - 1.1 * radius, 0.001 * distance));
    camera.far = static_cast<float>(distance + 1.1 * radius);
    return camera;
}

}  // namespace burnish
