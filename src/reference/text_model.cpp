#include "reference/text_model.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <unordered_map>
#include <utility>

#include "models/model_texts.hpp"
#include "models/terms.hpp"
#include "reference/surface_sampler.hpp"

namespace burnish::reference {

namespace {

double power(double x, double y) {
    if (y == 0.0) return 1.0;
    if (x > 0.0) return std::pow(x, y);
    return y > 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
}

glm::dvec3 computed(ExprOp op, const glm::dvec3& a, const glm::dvec3& b) {
    switch (op) {
        case ExprOp::add:
            return a + b;
        case ExprOp::multiply:
            return a * b;
        case ExprOp::divide:
            return a / b;
        case ExprOp::dot:
            return glm::dvec3(glm::dot(a, b));
        case ExprOp::power:
            return glm::dvec3(power(a.x, b.x));
        case ExprOp::square_root:
            return glm::dvec3(std::sqrt(a.x < 0.0 ? 0.0 : a.x));
        case ExprOp::exponential:
            return glm::dvec3(std::exp(a.x));
        case ExprOp::minimum:
            return glm::min(a, b);
        case ExprOp::maximum:
            return glm::max(a, b);
        default:  // a quantity is what it stands for
            return a;
    }
}

glm::dvec3 parameter(const std::string& name, const TexelParameters& p) {
    const std::pair<const char*, glm::dvec3> values[] = {{"n", p.n},
                                                         {"t", p.t},
                                                         {"b", p.b},
                                                         {"alpha_x", glm::dvec3(p.alpha_x)},
                                                         {"alpha_y", glm::dvec3(p.alpha_y)},
                                                         {"N", glm::dvec3(p.exponent)},
                                                         {"ks", p.ks},
                                                         {"kd", p.kd}};
    for (const auto& [known, value] : values) {
        if (name == known) return value;
    }
    return glm::dvec3(std::numeric_limits<double>::quiet_NaN());
}

glm::dvec3 geometry(const std::string& name, const Directions& to) {
    if (name == "l") return to.l;
    if (name == "v") return to.v;
    if (name == "h") return to.h;
    if (name == "n_dot_l") return glm::dvec3(std::max(to.l.z, 0.0));
    return glm::dvec3(std::clamp(to.h_l, 0.0, 1.0));
}

/// Nodes of an operation at or below `values`, each once.
std::vector<const Expr*> leaves_of(const std::vector<const Expr*>& values, ExprOp op) {
    std::vector<const Expr*> found;
    std::unordered_map<const Expr*, bool> seen;  // looked up only
    const std::function<void(const Expr&)> visit = [&](const Expr& e) {
        if (!seen.emplace(&e, true).second) return;
        if (e.op == op) found.push_back(&e);
        for (const ExprPtr& arg : e.args) visit(*arg);
    };
    for (const Expr* value : values) visit(*value);
    return found;
}

}  // namespace

Formula::Formula(const Expr& value, const std::vector<const Expr*>& leaves)
    : m_leaves(leaves.size()) {
    std::unordered_map<const Expr*, std::size_t> places;  // looked up only
    for (std::size_t i = 0; i < leaves.size(); ++i) places.emplace(leaves[i], i);
    const std::function<std::size_t(const Expr&)> place_of = [&](const Expr& e) {
        const auto known = places.find(&e);
        if (known != places.end()) return known->second;
        Step step{e.op, e.value, 0, 0};
        if (!e.args.empty()) step.a = place_of(*e.args.front());
        if (!e.args.empty()) step.b = place_of(*e.args.back());
        m_steps.push_back(step);
        const std::size_t place = m_leaves + m_steps.size() - 1;
        places.emplace(&e, place);
        return place;
    };
    m_value = place_of(value);
}

glm::dvec3 Formula::operator()(std::vector<glm::dvec3> leaves) const {
    std::vector<glm::dvec3>& values = leaves;
    values.reserve(m_leaves + m_steps.size());
    for (const Step& step : m_steps) {
        values.push_back(step.op == ExprOp::constant
                             ? step.constant
                             : computed(step.op, values[step.a], values[step.b]));
    }
    return values[m_value];
}

TextSurface operator*(TextSurface surface, double factor) {
    for (glm::dvec3& value : surface.values) value *= factor;
    return surface;
}

TextSurface operator+(TextSurface a, const TextSurface& b) {
    for (std::size_t i = 0; i < a.values.size(); ++i) a.values[i] += b.values[i];
    return a;
}

TextModel::TextModel(const Material& material, const std::function<bool()>& stop)
    : m_source(material, stop), m_has_mipmaps(material.mipmaps.has_value()) {
    ExprBuilder builder;
    m_value = model_expression(material, builder);
    m_quantities = quantities_of(*m_value);
    m_parameters = leaves_of(m_quantities, ExprOp::parameter);
    m_geometry = leaves_of({m_value.get()}, ExprOp::geometry);
    for (const Expr* quantity : m_quantities)
        m_definitions.emplace_back(*quantity->args.front(), m_parameters);
    std::vector<const Expr*> leaves = m_quantities;
    leaves.insert(leaves.end(), m_geometry.begin(), m_geometry.end());
    m_formula.emplace(*m_value, leaves);
    if (!m_source.varies()) m_constant = texel(m_source.at(0, 0));
    find_extremes();
}

void TextModel::find_extremes() {
    for (std::size_t i = 0; i < m_quantities.size(); ++i) {
        if (m_quantities[i]->extreme == Extreme::none) continue;
        m_extremes.emplace_back(i, texel(m_source.at(0, 0)).values[i]);
    }
    if (m_extremes.empty()) return;
    for (int level = 0; level < m_source.levels(); ++level) {
        for (int y = 0; y < m_source.height(level); ++y) {
            m_source.require_wanted();
            for (int x = 0; x < m_source.width(level); ++x) {
                const TextSurface here = texel(m_source.at(level, x, y));
                for (auto& [i, value] : m_extremes) {
                    const bool is_least = m_quantities[i]->extreme == Extreme::least;
                    value = is_least ? glm::min(value, here.values[i])
                                     : glm::max(value, here.values[i]);
                }
            }
        }
    }
}

TextModel::TextModel(const Material& material, std::span<const LayerQuantity> layer)
    : TextModel(material) {
    for (const Expr* quantity : m_quantities) {
        const auto at = std::find_if(layer.begin(), layer.end(), [&](const LayerQuantity& q) {
            return q.name == quantity->name;
        });
        m_layer.push_back(at == layer.end() ? std::nullopt : std::optional(*at));
    }
}

TextSurface TextModel::texel(const TexelParameters& parameters) const {
    std::vector<glm::dvec3> leaves;
    for (const Expr* leaf : m_parameters) leaves.push_back(parameter(leaf->name, parameters));
    TextSurface surface;
    for (const Formula& definition : m_definitions) surface.values.push_back(definition(leaves));
    return surface;
}

TextSurface TextModel::exact(const glm::dvec2& uv, const CoordinateSteps& steps) const {
    if (m_constant) return *m_constant;
    const auto is_log = [&](std::size_t i) {
        return m_quantities[i]->coding == ExponentCoding::logarithmic;
    };
    TextSurface mean = filtered_texels(m_source, uv, steps, [&](const TexelParameters& parameters) {
        TextSurface values = texel(parameters);
        for (std::size_t i = 0; i < values.values.size(); ++i)
            if (is_log(i)) values.values[i] = glm::log2(values.values[i]);
        return values;
    });
    for (std::size_t i = 0; i < mean.values.size(); ++i)
        if (is_log(i)) mean.values[i] = glm::exp2(mean.values[i]);
    return mean;
}

TextSurface TextModel::at(const glm::dvec2& uv, const CoordinateSteps& all_steps) const {
    const CoordinateSteps steps = m_has_mipmaps ? all_steps : CoordinateSteps{};
    const bool all_coded = !m_layer.empty() && std::all_of(m_layer.begin(), m_layer.end(),
                                                           [](const auto& q) { return bool(q); });
    TextSurface surface =
        all_coded ? TextSurface{std::vector<glm::dvec3>(m_quantities.size())} : exact(uv, steps);
    for (std::size_t i = 0; i < m_layer.size(); ++i) {
        if (m_layer[i]) surface.values[i] = layer_value(*m_layer[i], uv, steps);
    }
    for (const auto& [i, value] : m_extremes) surface.values[i] = value;
    return surface;
}

glm::dvec3 TextModel::reflected(const TextSurface& surface, const Directions& to) const {
    std::vector<glm::dvec3> leaves = surface.values;
    for (const Expr* leaf : m_geometry) leaves.push_back(geometry(leaf->name, to));
    const glm::dvec3 value = (*m_formula)(std::move(leaves));
    return {value.x > 0.0 ? value.x : 0.0, value.y > 0.0 ? value.y : 0.0,
            value.z > 0.0 ? value.z : 0.0};
}

}  // namespace burnish::reference
