#include "models/material_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "models/bounds.hpp"
#include "models/model_texts.hpp"

namespace burnish {

namespace {

[[noreturn]] void fail_unbounded(const Expr& quantity, const std::string& material) {
    const Expr& value = *quantity.args.front();
    throw Error(ErrorCode::bad_program,
                fmt::format("material '{}', model_text:{}:{}: {} is not finite at every texel, "
                            "expected a bound, as max(1/32, ...)",
                            material, value.line, value.column, print_expression(value)));
}

/// A quantity at texel `x` of the row that `texels` is at.
glm::dvec3 value_at(const TexelQuantities& texels, const Expr& q, std::size_t x) {
    return {texels.component(q, 0)[x], texels.component(q, 1)[x], texels.component(q, 2)[x]};
}

/// The first texel of a row where a quantity is not finite: the row's width if there is none.
std::size_t first_unbounded(const TexelQuantities& texels, const Expr& q) {
    const std::span<const double> a = texels.component(q, 0), b = texels.component(q, 1),
                                  c = texels.component(q, 2);
    std::size_t x = 0;
    while (x < a.size() && std::isfinite((a[x] * a[x] + b[x] * b[x]) + c[x] * c[x])) ++x;
    return x;
}

/// Takes a row into account.
void include_row(QuantityValues& v, const TexelQuantities& texels, const Expr& q, bool first) {
    if (first) {
        v.somewhere = v.low = v.high = value_at(texels, q, 0);
        v.shortest = v.longest = std::sqrt(glm::dot(v.low, v.low));
    }
    const bool is_scalar = q.kind == ValueKind::scalar;
    for (int c = 0; c < (is_scalar ? 1 : 3); ++c) {
        double low = v.low[c], high = v.high[c];
        for (const double x : texels.component(q, c)) {
            low = std::min(low, x);
            high = std::max(high, x);
        }
        v.low[c] = low;
        v.high[c] = high;
    }
    if (is_scalar) {
        v.low = glm::dvec3(v.low.x);
        v.high = glm::dvec3(v.high.x);
    }
    if (q.kind != ValueKind::vector) return;
    const std::span<const double> a = texels.component(q, 0), b = texels.component(q, 1),
                                  c = texels.component(q, 2);
    for (std::size_t x = 0; x < a.size(); ++x) {
        const glm::dvec3 at(a[x], b[x], c[x]);
        const double length = std::sqrt(glm::dot(at, at));
        v.shortest = std::min(v.shortest, length);
        v.longest = std::max(v.longest, length);
        if (length > 0.0) v.spread = glm::max(v.spread, glm::abs(at) / (length * length));
    }
}

}  // namespace

MaterialTerms::MaterialTerms(const Material& material, std::function<bool()> stop)
    : m_value(model_expression(material, m_builder)),
      m_source(material, std::move(stop)),
      m_texels(quantities_of(*m_value), m_source) {
    look_at_texels(material.name);

    // Numbers and colours that do not vary are constants of the program.
    std::vector<std::pair<const Expr*, glm::dvec3>> constants;
    for (const auto& [quantity, v] : m_quantities) {
        const Extreme extreme = quantity->extreme;
        if (extreme == Extreme::none && v.low != v.high) continue;
        // Registers hold no signs in constants; a vector of length 0 is none.
        if (quantity->kind == ValueKind::vector && v.longest > 0.0) continue;
        constants.emplace_back(quantity, extreme == Extreme::most ? v.high : v.low);
        LayerQuantity same;
        same.name = quantity->name;
        same.components = quantity->kind == ValueKind::scalar ? 1 : 3;
        same.constant = constants.back().second;
        same.definition = print_expression(*quantity->args.front());
        m_constants.push_back(std::move(same));
    }
    m_value = with_constants(m_value, m_builder, constants);
    m_terms = terms_of(m_value, m_builder);
    for (const auto& [quantity, v] : m_quantities) {
        if (quantity->kind == ValueKind::vector) {
            m_ranges.set(quantity, {v.shortest, v.longest});
        } else {
            m_ranges.set(quantity, {std::min({v.low.x, v.low.y, v.low.z}),
                                    std::max({v.high.x, v.high.y, v.high.z})});
        }
    }
    require_bounds(roots(), m_ranges, material.name);
}

std::vector<const Expr*> MaterialTerms::roots() const {
    std::vector<const Expr*> roots;
    for (const ModelTerm& term : m_terms) {
        if (term.scalar) roots.push_back(term.scalar.get());
    }
    return roots;
}

void MaterialTerms::look_at_texels(const std::string& material) {
    const std::vector<const Expr*>& all = m_texels.quantities();
    for (int level = 0; level < m_source.levels(); ++level) {
        for (int y = 0; y < m_source.height(level); ++y) {
            m_texels.seek(level, y);
            m_most_tilt = std::max(m_most_tilt, m_texels.tilt());
            auto unbounded = static_cast<std::size_t>(m_source.width(level));
            const Expr* cause = nullptr;
            for (const Expr* q : all) {
                const std::size_t x = first_unbounded(m_texels, *q);
                if (x < unbounded) cause = q;
                unbounded = std::min(unbounded, x);
            }
            if (cause != nullptr) fail_unbounded(*cause, material);
            for (const Expr* q : all)
                include_row(m_quantities[q], m_texels, *q, level == 0 && y == 0);
        }
    }
}

}  // namespace burnish
