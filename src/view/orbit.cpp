#include "view/orbit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dmath.hpp"

namespace burnish::view {
namespace {

constexpr double kDegree = dmath::kPi / 180.0;

/// Half of the angle of view, in radians.
double half_view(const Camera& camera) {
    return 0.5 * static_cast<double>(camera.view_angle) * kDegree;
}

struct Axes {
    glm::vec3 right, up, back;
};

/// The direction of `v`, whose square may be no float; upwards where it has none.
glm::vec3 unit(const glm::vec3& v) {
    const glm::dvec3 exact(v);
    const double length = glm::length(exact);
    return length > 0.0 ? glm::vec3(exact / length) : glm::vec3(0.0F, 1.0F, 0.0F);
}

/// Some unit vector at right angles to `v`.
glm::vec3 any_perpendicular(const glm::vec3& v) {
    const glm::vec3 other = std::abs(v.y) < 0.9F * glm::length(v) ? glm::vec3(0.0F, 1.0F, 0.0F)
                                                                  : glm::vec3(1.0F, 0.0F, 0.0F);
    return glm::normalize(glm::cross(other, v));
}

Axes axes_of(const Camera& camera) {
    const glm::vec3 back = unit(camera.position - camera.focal_point);
    const glm::vec3 side = glm::cross(unit(camera.view_up), back);
    const float length = glm::length(side);
    const glm::vec3 right = length > 1e-6F ? side / length : any_perpendicular(back);
    return {right, glm::cross(back, right), back};
}

glm::vec3 rotated(const glm::vec3& v, const glm::vec3& axis, float degrees) {
    return glm::mat3(placement(glm::vec3(0.0F), axis, degrees, 1.0F)) * v;
}

void grow(Bounds& box, const glm::vec3& point) {
    box.low = glm::min(box.low, point);
    box.high = glm::max(box.high, point);
}

/// The corners of a mesh's box, in world space.
void grow(Bounds& box, const Bounds& mesh, const glm::mat4& world_from_object) {
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 at((corner & 1) != 0 ? mesh.high.x : mesh.low.x,
                           (corner & 2) != 0 ? mesh.high.y : mesh.low.y,
                           (corner & 4) != 0 ? mesh.high.z : mesh.low.z);
        grow(box, glm::vec3(world_from_object * glm::vec4(at, 1.0F)));
    }
}

}  // namespace

Ball ball_around(const Scene& scene) {
    constexpr float kNone = std::numeric_limits<float>::max();
    Bounds box{glm::vec3(kNone), glm::vec3(-kNone)};
    for (const Object& object : scene.objects) {
        if (const Mesh* mesh = std::get_if<Mesh>(&object.geometry)) {
            const Bounds bounds = mesh->bounds();
            if (glm::all(glm::lessThanEqual(bounds.low, bounds.high)))
                grow(box, bounds, object.world_from_object);
        } else if (const auto& raw = std::get<RawVertices>(object.geometry);
                   raw.space == Space::object) {
            for (const RawVertex& vertex : raw.vertices)
                grow(box, glm::vec3(object.world_from_object *
                                    glm::vec4(glm::vec3(vertex.position), 1)));
        }
    }
    const float radius = 0.5F * glm::length(box.high - box.low);
    if (!std::isfinite(radius) || box.low.x > box.high.x) return {};
    return {0.5F * box.low + 0.5F * box.high, std::max(radius, 1e-6F)};
}

Camera by_vectors(const Camera& camera, const Ball& ball) {
    Camera result = camera;
    if (camera.view) {
        const glm::mat4 world_from_eye = glm::inverse(*camera.view);
        const glm::vec3 back = glm::normalize(glm::vec3(world_from_eye[2]));
        result.position = glm::vec3(world_from_eye[3]);
        result.view_up = glm::normalize(glm::vec3(world_from_eye[1]));
        const float ahead = glm::dot(result.position - ball.centre, back);
        result.focal_point = result.position - back * std::max(ahead, 0.1F * ball.radius);
        result.view.reset();
    }
    if (camera.projection) {
        const double focal = std::abs(static_cast<double>((*camera.projection)[1][1]));
        if (focal > 0.0)
            result.view_angle = static_cast<float>(
                std::clamp(2.0 * dmath::atan(1.0 / focal) / kDegree, 1.0, 170.0));
        result.projection.reset();
    }
    return result;
}

Camera orbited(Camera camera, float azimuth, float elevation) {
    const glm::vec3 up = unit(camera.view_up);
    glm::vec3 arm = rotated(camera.position - camera.focal_point, up, -azimuth);
    const float sine = glm::dot(unit(arm), up);
    const double from_pole = dmath::acos(std::clamp(static_cast<double>(sine), -1.0, 1.0));
    const auto height = static_cast<float>(90.0 - from_pole / kDegree);
    const float higher = std::clamp(height + elevation, -89.0F, 89.0F) - height;
    const glm::vec3 side = glm::cross(up, arm);
    if (glm::length(side) > 1e-6F * glm::length(arm)) arm = rotated(arm, unit(side), -higher);
    camera.position = camera.focal_point + arm;
    return camera;
}

Camera panned(Camera camera, float right, float down) {
    const Axes axes = axes_of(camera);
    const float distance = glm::length(camera.position - camera.focal_point);
    const float height = 2.0F * distance * static_cast<float>(dmath::tan(half_view(camera)));
    const glm::vec3 move = height * (down * axes.up - right * axes.right);
    camera.position += move;
    camera.focal_point += move;
    return camera;
}

Camera zoomed(Camera camera, float factor, const Ball& ball) {
    // Squares of what a file says may be more than a float holds.
    const glm::dvec3 arm = glm::dvec3(camera.position) - glm::dvec3(camera.focal_point);
    const double length = glm::length(arm);
    if (length == 0.0) return camera;
    const auto radius = static_cast<double>(ball.radius);
    const double wanted =
        std::clamp(length / static_cast<double>(factor), 1e-3 * radius, 1e3 * radius);
    camera.position = glm::vec3(glm::dvec3(camera.focal_point) + arm * (wanted / length));
    return camera;
}

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool has_direction(const Camera& camera) {
    return is_finite(camera.position) && is_finite(camera.focal_point) &&
           is_finite(camera.view_up) && camera.position != camera.focal_point;
}

Camera seen_from(Side side, const Camera& camera, const Ball& ball, float aspect) {
    constexpr glm::vec3 kFrom[] = {
        {0.0F, 0.0F, 1.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {1.0F, 1.0F, 1.0F}};
    Camera result = camera;
    const double half_height = half_view(camera);
    const double half = aspect < 1.0F
                            ? dmath::atan(dmath::tan(half_height) * static_cast<double>(aspect))
                            : half_height;
    const glm::vec3 from = glm::normalize(kFrom[static_cast<int>(side)]);
    result.focal_point = ball.centre;
    result.position = ball.centre + from * (ball.radius / static_cast<float>(dmath::sin(half)));
    result.view_up = side == Side::top ? glm::vec3(0.0F, 0.0F, -1.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
    return result;
}

Camera with_depths(Camera camera, const Ball& ball) {
    const float distance = glm::length(camera.position - ball.centre);
    const float nearest = std::max(distance - 1.1F * ball.radius, 1e-3F * ball.radius);
    camera.near = std::min(camera.near, nearest);
    camera.far = std::max(camera.far, distance + 1.1F * ball.radius);
    return camera;
}

glm::vec3 turned_light(const glm::vec3& towards, const Camera& camera, float right, float down) {
    const Axes axes = axes_of(camera);
    return rotated(rotated(towards, axes.up, right), axes.right, down);
}

}  // namespace burnish::view
