#include "reference/surface.hpp"

#include <cmath>
#include <numbers>

namespace burnish::reference {

namespace {

constexpr glm::dvec3 Surface::*kMembers[] = {
    &Surface::n,   &Surface::t,   &Surface::X,   &Surface::Y,  &Surface::U,
    &Surface::V,   &Surface::P,   &Surface::Q,   &Surface::ks, &Surface::kd,
    &Surface::N,   &Surface::S,   &Surface::A,   &Surface::Bx, &Surface::By,
    &Surface::Mxx, &Surface::Mxy, &Surface::Myy, &Surface::E};

/// Height of the lobe.
double height(Model model, double alpha_x, double alpha_y) {
    const double area = std::numbers::pi * alpha_x * alpha_y;
    if (model == Model::ggx) return 1.0 / (2.0 * area);
    if (model != Model::ashikhmin_shirley) return 1.0 / (4.0 * area);
    const double nu = 2.0 / (alpha_x * alpha_x), nv = 2.0 / (alpha_y * alpha_y);
    return std::sqrt((nu + 1.0) * (nv + 1.0)) / (8.0 * std::numbers::pi);
}

}  // namespace

Surface operator*(const Surface& surface, double factor) {
    Surface product;
    for (const auto member : kMembers) product.*member = surface.*member * factor;
    return product;
}

Surface operator+(const Surface& a, const Surface& b) {
    Surface sum;
    for (const auto member : kMembers) sum.*member = a.*member + b.*member;
    return sum;
}

namespace {

/// A lobe of variances alpha^2 / 2 along t and b at n, seen in slopes. A half vector that is moved
/// from n along t by s has its slope moved by (t - n t.z / n.z) s / n.z.
void add_moments(Surface& s, const TexelParameters& p) {
    const double nz = std::max(p.n.z, 1.0 / 64.0);
    const auto moved = [&](const glm::dvec3& along, double alpha) {
        return glm::dvec2(along - p.n * (along.z / nz)) * (alpha / (std::numbers::sqrt2 * nz));
    };
    const glm::dvec2 mean = glm::dvec2(p.n) / nz;
    const glm::dvec2 a = moved(p.t, p.alpha_x), c = moved(p.b, p.alpha_y);
    s.Bx = glm::dvec3(mean.x);
    s.By = glm::dvec3(mean.y);
    s.Mxx = glm::dvec3(mean.x * mean.x + a.x * a.x + c.x * c.x);
    s.Mxy = glm::dvec3(mean.x * mean.y + a.x * a.y + c.x * c.y);
    s.Myy = glm::dvec3(mean.y * mean.y + a.y * a.y + c.y * c.y);
    s.E = p.ks / (8.0 * std::numbers::pi * nz * nz * nz);
}

}  // namespace

Surface surface_of(Model model, const TexelParameters& p) {
    const bool round = model == Model::blinn_phong;
    const double peak = height(model, p.alpha_x, p.alpha_y);
    Surface s;
    s.n = p.n;
    s.t = p.t;
    const auto narrowing = [&](double alpha) {
        if (model == Model::ggx) return std::sqrt(1.0 / (alpha * alpha) - 1.0);
        return round ? 1.0 : 1.0 / alpha;
    };
    s.X = p.t * narrowing(p.alpha_x);
    s.Y = p.b * narrowing(p.alpha_y);
    s.U = p.t * (std::numbers::sqrt2 / p.alpha_x);
    s.V = p.b * (std::numbers::sqrt2 / p.alpha_y);
    s.P = p.t * p.alpha_x;
    s.Q = p.b * p.alpha_y;
    s.ks = p.ks;
    s.kd = p.kd;
    s.N = glm::dvec3(p.exponent);
    const bool schlick = model == Model::ashikhmin_shirley || model == Model::ggx;
    s.A = p.ks * peak;
    s.S = schlick ? glm::dvec3(peak) : s.A;
    if (model == Model::lean) add_moments(s, p);
    return s;
}

}  // namespace burnish::reference
