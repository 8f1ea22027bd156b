#include "reference/surface.hpp"

#include <cmath>
#include <numbers>

namespace burnish::reference {

namespace {

constexpr glm::dvec3 Surface::*kMembers[] = {
    &Surface::n, &Surface::t,  &Surface::X,  &Surface::Y, &Surface::U, &Surface::V, &Surface::P,
    &Surface::Q, &Surface::ks, &Surface::kd, &Surface::N, &Surface::S, &Surface::A};

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
    return s;
}

}  // namespace burnish::reference
