#include "models/layer.hpp"

#include <cmath>
#include <numbers>

namespace burnish {

glm::dvec3 LayerQuantity::decoded(const glm::dvec3& x) const {
    return scale * x + offset;
}

// A stand-in until the real one lands: materials without maps.
std::vector<LayerQuantity> material_layer(const Material& m, const Machine&) {
    const glm::dvec3 n(0, 0, 1), t(1, 0, 0), b(0, 1, 0), ks(m.ks), kd(m.kd);
    const double ax = static_cast<double>(m.alpha_x), ay = static_cast<double>(m.alpha_y),
                 exponent = static_cast<double>(m.exponent);
    std::vector<LayerQuantity> out;
    const auto vec = [&](const char* name, glm::dvec3 v) {
        LayerQuantity q;
        q.name = name;
        q.components = 3;
        q.constant = v;
        out.push_back(q);
    };
    const bool plain = m.model == Model::blinn_phong;
    vec("n", n);
    vec("t", t);
    vec("X", plain ? t : t / ax);
    vec("Y", plain ? b : b / ay);
    vec("ks", ks);
    vec("kd", kd);
    vec("N", glm::dvec3(exponent));
    const double nu = 2.0 / (ax * ax), nv = 2.0 / (ay * ay);
    vec("U", t * std::sqrt(nu));
    vec("V", b * std::sqrt(nv));
    vec("P", t * ax);
    vec("Q", b * ay);
    const double area = std::numbers::pi * ax * ay;
    double s = 1 / (2 * area);
    if (m.model == Model::ashikhmin_shirley)
        s = std::sqrt((nu + 1) * (nv + 1)) / (8 * std::numbers::pi);
    vec("A", ks * s);
    vec("C", (1.0 - ks) * s);
    vec("S", ks / (4.0 * area));
    return out;
}

}  // namespace burnish
