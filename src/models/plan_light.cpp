#include "models/plan_light.hpp"

#include <algorithm>
#include <burnish/error.hpp>
#include <cstddef>
#include <optional>
#include <vector>

namespace burnish {

namespace {

class LightPlanner {
  public:
    LightPlanner(const PlanTask& task, Plan& plan, PlanBuilder& values,
                 const std::function<PlanOperand(const Expr&)>& lower)
        : m_task(task), m_plan(plan), m_values(values), m_lower(lower) {}

    /// The final combiner takes the last product, and one more inside it; the rest is summed
    /// before.
    void finish() {
        glm::dvec3 base = m_task.ambient;
        std::vector<PlanProduct> products;
        std::vector<const ModelTerm*> of_vertices;
        for (const ModelTerm& term : *m_task.terms) {
            if (m_task.light * term.factor == glm::dvec3(0.0)) continue;
            if (comes_with_vertices(term)) {
                of_vertices.push_back(&term);
            } else {
                products.push_back(lit(term));
            }
        }
        // Their colour is the one that a second vector takes.
        const bool has_place = vector_inputs() < 2;
        for (const ModelTerm* term : of_vertices) {
            if (has_place) {
                m_plan.lit_tint += m_task.light * term->factor;
            } else {
                products.push_back(lit(*term));
            }
        }
        const auto last = std::find_if(products.begin(), products.end(),
                                       [&](const PlanProduct& p) { return fits_final(p); });
        if (last != products.end()) {
            final_product(*last);
            products.erase(last);
        }
        if (m_plan.lit_tint != glm::dvec3(0.0)) {
            m_plan.lit_base = base;
            const PlanInput lit_input = m_values.input("lit", ValueKind::color);
            if (products.empty()) {
                m_plan.final.d = lit_input;
                return;
            }
            products.push_back({lit_input, m_values.one(), 1.0});
        } else if (base != glm::dvec3(0.0)) {
            const PlanInput constant_base = m_values.constant(ValueKind::color, base);
            if (products.empty()) {
                m_plan.final.d = constant_base;
                return;
            }
            products.push_back({constant_base, m_values.one(), 1.0});
        }
        if (!products.empty()) m_plan.final.d = summed(products);
    }

  private:
    /// What varies of a term's colour.
    PlanOperand color(const Expr& e) {
        if (e.op == ExprOp::multiply) {
            const PlanOperand a = color(*e.args[0]);
            const PlanOperand b = color(*e.args[1]);
            return m_values.arithmetic(ValueKind::color, {a.input, b.input, a.unit * b.unit},
                                       a.unit * b.unit);
        }
        const QuantityValues& values = m_task.quantities.at(&e);
        PlanQuantity q{.name = e.name, .expr = &e, .kind = ValueKind::color, .unit = {}};
        q.unit = glm::dvec3(std::max(largest(values.high), 1e-6));
        return {m_values.quantity(q), q.unit.x};
    }

    /// A term with its light as a product that is right in units of `unit`, a power of two.
    PlanProduct lit(const ModelTerm& term) {
        PlanOperand x = term.scalar ? m_lower(*term.scalar) : PlanOperand{m_values.one(), 1.0};
        if (term.color) {
            const PlanOperand c = color(*term.color);
            const double unit = x.unit * c.unit;
            x = term.scalar ? m_values.arithmetic(ValueKind::color, {x.input, c.input, unit}, unit)
                            : c;
        }
        const glm::dvec3 k = m_task.light * term.factor * x.unit;
        const bool negative = k.x < 0.0 || k.y < 0.0 || k.z < 0.0;
        if (negative && (k.x > 0.0 || k.y > 0.0 || k.z > 0.0))
            throw Error(ErrorCode::bad_program, "a colour of both signs, expected one sign a term");
        const double most = largest(glm::abs(k));
        double unit = 1.0;
        while (unit < most * (1.0 - 1e-9) && unit < 4.0) unit *= 2.0;
        if (most > 4.0) {
            x = m_values.in_units(x, x.unit * 4.0 / most,
                                  term.color ? ValueKind::color : ValueKind::scalar);
            unit = 4.0;
        }
        PlanInput factor = m_values.constant(ValueKind::color,
                                             glm::abs(m_task.light * term.factor * x.unit) / unit);
        if (negative)
            factor.mapping = factor == m_values.one() ? Mapping::expand : Mapping::signed_negate;
        return {x.input, factor, unit};
    }

    PlanProduct in_color_units(PlanProduct p, double unit) {
        if (p.unit == unit) return p;
        const PlanOperand x = m_values.arithmetic(ValueKind::color, p, p.unit);
        return {x.input, m_values.constant(p.unit / unit), unit};
    }

    [[nodiscard]] std::ptrdiff_t vector_inputs() const {
        return std::count_if(m_plan.values.begin(), m_plan.values.end(), [](const PlanValue& v) {
            return v.op == PlanOp::input && v.kind == ValueKind::vector;
        });
    }

    bool comes_with_vertices(const ModelTerm& term) const {
        const glm::dvec3 k = m_task.light * term.factor;
        return m_task.vertex_light && !term.color && term.scalar &&
               term.scalar->op == ExprOp::geometry && term.scalar->name == "n_dot_l" &&
               std::min({k.x, k.y, k.z}) >= 0.0;
    }

    /// Inputs of the final combiner are not negative, and products have no scale.
    bool fits_final(const PlanProduct& p) const {
        return p.unit == 1.0 && !m_values.is_signed(p.a) && !m_values.is_signed(p.b);
    }

    /// Three factors multiply in the final combiner; of more, those that are known first have been
    /// multiplied before.
    void final_product(const PlanProduct& p) {
        std::vector<PlanInput> factors = factors_of(p.a);
        if (p.b != m_values.one()) factors.push_back(p.b);
        while (factors.size() > 3) {
            std::stable_sort(
                factors.begin(), factors.end(),
                [&](const PlanInput& x, const PlanInput& y) { return depth_of(x) < depth_of(y); });
            const ValueKind kind = std::max(kind_of(factors[0]), kind_of(factors[1]));
            factors[1] = m_values.arithmetic(kind, {factors[0], factors[1], 1.0}, 1.0).input;
            factors.erase(factors.begin());
        }
        PlanFinal& f = m_plan.final;
        f.a = factors[0];
        f.b = factors.size() == 2 ? factors[1] : m_values.one();
        if (factors.size() < 3) return;
        f.has_product = true;
        f.e = factors[1];
        f.f = factors[2];
    }

    /// What is multiplied to an operand without scales, where the parts are as good as the whole.
    std::vector<PlanInput> factors_of(const PlanInput& i) const {
        if (i.value < 0 || i.mapping == Mapping::unsigned_invert) return {i};
        const PlanValue& v = m_plan.values[static_cast<std::size_t>(i.value)];
        const bool splits = v.op == PlanOp::arithmetic && v.products == 1 && !v.is_dot &&
                            v.doublings == 0 && !m_values.is_signed(v.factors[0]) &&
                            !m_values.is_signed(v.factors[1]);
        if (!splits) return {i};
        std::vector<PlanInput> all = factors_of(v.factors[0]);
        const std::vector<PlanInput> more = factors_of(v.factors[1]);
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    int depth_of(const PlanInput& i) const {
        if (i.value < 0) return 0;
        const PlanValue& v = m_plan.values[static_cast<std::size_t>(i.value)];
        int depth = 0;
        if (v.op == PlanOp::arithmetic) {
            for (int k = 0; k < 2 * v.products; ++k)
                depth = std::max(depth, 1 + depth_of(v.factors[static_cast<std::size_t>(k)]));
        } else if (v.op == PlanOp::table) {
            for (const PlanAxis& axis : m_plan.tables[static_cast<std::size_t>(v.index)].axes)
                depth = std::max(depth, depth_of(axis.input));
        }
        return depth;
    }

    ValueKind kind_of(const PlanInput& i) const {
        return i.value < 0 ? ValueKind::scalar
                           : m_plan.values[static_cast<std::size_t>(i.value)].kind;
    }

    PlanInput summed(const std::vector<PlanProduct>& products) {
        if (products.size() == 1 && products[0].b == m_values.one() && products[0].unit == 1.0)
            return products[0].a;
        std::optional<PlanOperand> sum_so_far;
        for (std::size_t i = 0; i < products.size();) {
            if (sum_so_far) {
                const double unit = std::max(products[i].unit, 1.0);
                sum_so_far =
                    m_values.sum(ValueKind::color,
                                 in_color_units({sum_so_far->input, m_values.one(), 1.0}, unit),
                                 in_color_units(products[i], unit), 1.0);
                i += 1;
            } else if (i + 1 < products.size()) {
                const double unit = std::max(products[i].unit, products[i + 1].unit);
                sum_so_far = m_values.sum(ValueKind::color, in_color_units(products[i], unit),
                                          in_color_units(products[i + 1], unit), 1.0);
                i += 2;
            } else {
                sum_so_far = m_values.arithmetic(ValueKind::color, products[i], 1.0);
                i += 1;
            }
        }
        return sum_so_far->input;
    }

    const PlanTask& m_task;
    Plan& m_plan;
    PlanBuilder& m_values;
    const std::function<PlanOperand(const Expr&)>& m_lower;
};

}  // namespace

void plan_light(const PlanTask& task, Plan& plan, PlanBuilder& values,
                const std::function<PlanOperand(const Expr&)>& lower) {
    LightPlanner(task, plan, values, lower).finish();
}

}  // namespace burnish
