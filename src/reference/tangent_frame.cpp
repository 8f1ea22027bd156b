#include "reference/tangent_frame.hpp"

#include <cmath>

namespace burnish::reference {

namespace {

/// dP/du and dP/dv, v growing upward, of any length; false where uv do not tell them apart.
bool surface_derivatives(const SurfacePoint& point, glm::dvec3& along_u, glm::dvec3& along_v) {
    const auto& [a, b, c] = point.corner;
    const glm::dvec3 e = b->position - a->position, f = c->position - a->position;
    const glm::dvec2 p = b->uv - a->uv, q = c->uv - a->uv;
    const double area = q.x * p.y - p.x * q.y;  // of uv with v upward: theirs goes down
    if (area == 0.0 || !std::isfinite(area)) return false;
    along_u = (f * p.y - e * q.y) / area;
    along_v = (f * p.x - e * q.x) / area;
    return glm::dot(along_u, along_u) > 0.0 && glm::dot(along_v, along_v) > 0.0;
}

}  // namespace

glm::dvec3 normalised(const glm::dvec3& x) {
    const double length = std::sqrt(glm::dot(x, x));
    return length > 0.0 ? x / length : x;
}

TangentFrame tangent_frame(const SurfacePoint& point, TangentFrames kind) {
    TangentFrame frame{point.mean(&DoubleVertex::tangent), point.mean(&DoubleVertex::bitangent),
                       point.mean(&DoubleVertex::normal)};
    if (kind == TangentFrames::mikktspace) return frame;
    glm::dvec3 u, v;
    if (kind == TangentFrames::derivative && surface_derivatives(point, u, v)) {
        frame.t = u;
        frame.b = v;
    }
    frame.n = normalised(frame.n);
    frame.t = normalised(frame.t - frame.n * glm::dot(frame.n, frame.t));
    const glm::dvec3 across = glm::cross(frame.n, frame.t);
    frame.b = glm::dot(across, frame.b) < 0.0 ? -across : across;
    return frame;
}

}  // namespace burnish::reference
