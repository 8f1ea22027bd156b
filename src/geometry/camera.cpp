#include "geometry/camera.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <cmath>

#include "core/dmath.hpp"

namespace burnish {

namespace {

[[noreturn]] void bad_camera(const std::string& why) {
    throw Error(ErrorCode::bad_option, "camera: " + why);
}

glm::dvec3 unit(const glm::dvec3& v, const char* what) {
    const double length = std::sqrt(glm::dot(v, v));
    if (!(length > 0.0) || !std::isfinite(length))
        bad_camera(fmt::format("{} has no direction", what));
    return v / length;
}

/// World to eye; the eye looks along -z.
glm::dmat4 look_at(const Camera& camera) {
    const glm::dvec3 position(camera.position);
    const glm::dvec3 back =
        unit(position - glm::dvec3(camera.focal_point), "focal_point - position");
    const glm::dvec3 right = unit(glm::cross(unit(glm::dvec3(camera.view_up), "view_up"), back),
                                  "view_up x line of sight");
    const glm::dvec3 up = glm::cross(back, right);
    glm::dmat4 m(1.0);
    const glm::dvec3 rows[3] = {right, up, back};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) m[column][row] = rows[row][column];
        m[3][row] = -glm::dot(rows[row], position);
    }
    return m;
}

glm::dmat4 perspective(const Camera& camera, double aspect) {
    const double angle = static_cast<double>(camera.view_angle);
    const double near = static_cast<double>(camera.near), far = static_cast<double>(camera.far);
    if (!(angle > 0.0 && angle < 180.0)) {
        bad_camera(fmt::format("view_angle {}, expected between 0 and 180 degrees", angle));
    }
    if (!(near > 0.0 && far > near) || !std::isfinite(far)) {
        bad_camera(fmt::format("near {}, far {}, expected 0 < near < far", near, far));
    }
    const double focal = 1.0 / dmath::tan(angle * (dmath::kPi / 360.0));
    glm::dmat4 m(0.0);
    m[0][0] = focal / aspect;
    m[1][1] = focal;
    m[2][2] = (far + near) / (near - far);
    m[2][3] = -1.0;
    m[3][2] = 2.0 * far * near / (near - far);
    return m;
}

glm::dmat4 inverse_of(const glm::dmat4& m, const char* what) {
    const double determinant = glm::determinant(m);
    if (!std::isfinite(determinant) || determinant == 0.0) {
        throw Error(ErrorCode::bad_option, fmt::format("{} has no inverse", what));
    }
    return glm::inverse(m);
}

}  // namespace

glm::dmat4 projection_matrix(const Camera& camera, int width, int height) {
    return camera.projection ? glm::dmat4(*camera.projection)
                             : perspective(camera, static_cast<double>(width) / height);
}

View make_view(const Camera& camera, int width, int height) {
    const glm::dmat4 view = camera.view ? glm::dmat4(*camera.view) : look_at(camera);
    const glm::dmat4 projection = projection_matrix(camera, width, height);
    const glm::dmat4 world_from_eye = inverse_of(view, "camera view matrix");
    return {projection * view, glm::dvec3(world_from_eye[3]), glm::dvec3(world_from_eye[2])};
}

Viewport make_viewport(const Machine& machine, int width, int height) {
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    return {0.5F * w,
            0.5F * h,
            w,
            h,
            static_cast<float>(1 << machine.subpixel_bits),
            machine.snap_floor ? 0.0F : 0.5F};
}

LightSpace light_space(const Light& light, const View& view, Viewer viewer,
                       const glm::mat4& world_from_object) {
    const glm::dmat4 object_from_world = inverse_of(glm::dmat4(world_from_object), "object matrix");
    LightSpace space;
    space.light_w = light.position_w == 0.0F ? 0.0F : 1.0F;
    const glm::dvec4 position(glm::dvec3(light.position), static_cast<double>(space.light_w));
    space.light = glm::vec3(object_from_world * position);
    const bool local = viewer == Viewer::local;
    space.eye_w = local ? 1.0F : 0.0F;
    space.eye = glm::vec3(object_from_world *
                          (local ? glm::dvec4(view.eye, 1.0) : glm::dvec4(view.back, 0.0)));
    return space;
}

}  // namespace burnish
