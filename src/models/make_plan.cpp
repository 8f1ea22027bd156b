#include "models/make_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <functional>
#include <optional>

#include "core/dmath.hpp"
#include "models/model_needs.hpp"
#include "models/plan_builder.hpp"
#include "models/plan_demand.hpp"
#include "models/plan_light.hpp"
#include "models/table_domain.hpp"

namespace burnish {

namespace {

bool is_half_vector(const Expr& e) {
    return e.op == ExprOp::geometry && e.name == "h";
}

TableDomains domains_of(const PlanTask& task, Cover& cover, Ranges& ranges) {
    TableDomains domains;
    for (const Expr* e : cover.tables())
        domains.emplace(e, table_domain(*e, cover.table(*e)->args, ranges, task.numbers));
    return domains;
}

class Planner {
  public:
    Planner(const PlanTask& task, Cover& cover, Ranges& ranges, FilledTables& tables)
        : m_task(task),
          m_cover(cover),
          m_ranges(ranges),
          m_tables(tables),
          m_domains(domains_of(task, cover, ranges)),
          m_demand(task, cover, ranges, m_domains) {}

    Plan make() {
        scale_half_vector();
        plan_light(m_task, m_plan, m_values, [this](const Expr& e) { return lower(e); });
        return std::move(m_plan);
    }

  private:
    /// Lobes about the normal end where their tangent vectors say so: within an ellipse, whose box
    /// bounds x and y of the half vector. What is clamped to the box is not inside the ellipse, so
    /// x and y can have the digits that the box leaves free.
    void scale_half_vector() {
        if (!m_task.scaled_half_vector) return;
        glm::dvec3 box(m_task.most_tilt);
        std::vector<glm::dvec3> axes;
        for (const auto& [e, reach] : m_demand.reaches()) {
            if (e->op != ExprOp::dot || !is_half_vector(*e->args[0]) ||
                e->args[1]->op == ExprOp::constant)
                continue;
            const QuantityValues& q = m_task.quantities.at(e->args[1].get());
            if (!q.is_tangent) continue;
            box += reach * q.spread;
            axes.push_back(q.somewhere);
        }
        box *= m_task.varies ? 1.5 : 1.05;
        // Along one axis alone, or two that are the same, nothing bounds the ellipse.
        const bool bounded = std::any_of(axes.begin(), axes.end(), [&](const glm::dvec3& a) {
            const glm::dvec3 across = glm::cross(axes.front(), a);
            return glm::dot(across, across) >
                   0.01 * glm::dot(axes.front(), axes.front()) * glm::dot(a, a);
        });
        if (!bounded) return;
        m_plan.half_scale = {std::max(1.0, 1.0 / box.x), std::max(1.0, 1.0 / box.y), 1.0};
    }

    // --- expressions ----------------------------------------------------------------------------

    PlanOperand lower(const Expr& e) {
        const auto at = m_lowered.find(&e);
        if (at != m_lowered.end()) return at->second;
        const PlanOperand made = m_cover.table(e) != nullptr ? table(e) : computed(e);
        m_lowered.emplace(&e, made);
        return made;
    }

    PlanOperand computed(const Expr& e) {
        switch (e.op) {
            case ExprOp::constant:
                return {m_values.constant(e.value.x < 0.0 ? -1.0 : 1.0), std::abs(e.value.x)};
            case ExprOp::geometry:
                return {m_values.input(e.name, ValueKind::scalar), 1.0};
            case ExprOp::quantity:
                return scalar_quantity(e);
            case ExprOp::dot:
                return dot(e);
            case ExprOp::multiply:
                return product(e);
            case ExprOp::add:
                return addition(e);
            case ExprOp::maximum:
                if (!is_number(*e.args[0], 0.0) && !is_number(*e.args[1], 0.0)) needs_table(e);
                return positive(is_number(*e.args[0], 0.0) ? *e.args[1] : *e.args[0]);
            case ExprOp::minimum: {
                if (const Expr* inner = symmetric_clamp(e))
                    return clamped(e, *inner, e.args[1]->value.x);
                const bool first = e.args[0]->op == ExprOp::constant;
                if (!first && e.args[1]->op != ExprOp::constant) needs_table(e);
                const Expr& bound = first ? *e.args[0] : *e.args[1];
                return m_values.in_units(lower(first ? *e.args[1] : *e.args[0]), bound.value.x);
            }
            case ExprOp::power: {
                if (e.args[1]->op != ExprOp::constant || squarings(e.args[1]->value.x) < 0)
                    needs_table(e);
                PlanOperand x = lower(*e.args[0]);
                for (int k = squarings(e.args[1]->value.x); k > 0; --k) {
                    const double unit = x.unit * x.unit;
                    x = m_values.arithmetic(ValueKind::scalar, {x.input, x.input, unit}, unit);
                }
                return x;
            }
            default:
                needs_table(e);
        }
    }
    [[noreturn]] static void needs_table(const Expr& e) {
        Shortage shortage(fmt::format("{} needs a table", print_expression(e)), {.tables = 1});
        shortage.line = e.line;
        shortage.column = e.column;
        throw shortage;
    }

    PlanOperand scalar_quantity(const Expr& e) {
        const QuantityValues& values = m_task.quantities.at(&e);
        PlanQuantity q{.name = e.name, .expr = &e, .unit = {}};
        const bool logarithmic = is_logarithmic(e, {values.low.x, values.high.x});
        if (logarithmic && !only_in_tables(e) && e.coding == ExponentCoding::logarithmic)
            throw Error(ErrorCode::bad_program,
                        "exponent_coding = log where combiners read N itself, expected linear or a "
                        "model that reads it in powers");
        if (logarithmic && only_in_tables(e)) {
            // Relative steps: the axis is a logarithm.
            q.logarithmic = true;
            q.low = dmath::log2(values.low.x);
            q.unit = glm::dvec3(dmath::log2(values.high.x) - q.low);
            return {m_values.quantity(q), 1.0};
        }
        q.is_signed = values.low.x < 0.0;
        q.unit = glm::dvec3(std::max({values.high.x, -values.low.x, 1e-6}));
        return {m_values.quantity(q), q.unit.x};
    }

    /// Whether combiners never see a quantity, so that its code may be any function of it.
    bool only_in_tables(const Expr& e) {
        const std::function<bool(const Expr&)> clean = [&](const Expr& x) {
            if (x.op == ExprOp::constant || x.op == ExprOp::dot || x.op == ExprOp::geometry)
                return true;
            if (const TableCut* cut = m_cover.table(x)) {
                return std::all_of(cut->args.begin(), cut->args.end(),
                                   [&](const Expr* arg) { return arg == &e || clean(*arg); });
            }
            if (&x == &e) return false;
            return std::all_of(x.args.begin(), x.args.end(),
                               [&](const ExprPtr& arg) { return clean(*arg); });
        };
        return std::all_of(m_task.terms->begin(), m_task.terms->end(), [&](const ModelTerm& term) {
            return !term.scalar || clean(*term.scalar);
        });
    }

    PlanOperand dot(const Expr& e) {
        const Expr& pixel = *e.args[0];
        const Expr& texel = *e.args[1];
        const double wanted = wanted_of(e);
        if (texel.op == ExprOp::constant) return dot_with_constant(pixel, texel.value, wanted);
        const auto shared = m_shared_units.find(&e);
        const double unit = shared == m_shared_units.end() ? unit_of_dot(e) : shared->second;
        PlanQuantity q{.name = texel.name,
                       .expr = &texel,
                       .kind = ValueKind::vector,
                       .unit = unit * scale_of(pixel)};
        return m_values.arithmetic(
            ValueKind::scalar,
            {m_values.input(pixel.name, ValueKind::vector), m_values.quantity(q), unit, true},
            wanted);
    }
    /// Constants hold no signs: those of a vector that has negative components are coded like it.
    PlanOperand dot_with_constant(const Expr& pixel, const glm::dvec3& v, double wanted) {
        const glm::dvec3 q = v / scale_of(pixel);
        const double unit = largest(glm::abs(q));
        const bool is_negative = std::min({q.x, q.y, q.z}) < 0.0;
        PlanInput constant_vector =
            m_values.constant(ValueKind::color, is_negative ? 0.5 * (q / unit) + 0.5 : q / unit);
        if (is_negative) constant_vector.mapping = Mapping::expand;
        return m_values.arithmetic(
            ValueKind::scalar,
            {m_values.input(pixel.name, ValueKind::vector), constant_vector, unit, true}, wanted);
    }
    double wanted_of(const Expr& e) { return std::max(m_demand.reach(e), 1e-6); }
    glm::dvec3 scale_of(const Expr& pixel) const {
        return is_half_vector(pixel) ? m_plan.half_scale : glm::dvec3(1.0);
    }
    /// The least power of two times what is wanted that the components of the quantity allow.
    double unit_of_dot(const Expr& e) {
        const QuantityValues& values = m_task.quantities.at(e.args[1].get());
        // (S h) . (Q / S)
        const glm::dvec3 most =
            glm::max(glm::abs(values.low), glm::abs(values.high)) / scale_of(*e.args[0]);
        double unit = wanted_of(e);
        while (unit < largest(most) * (1.0 - 1e-9)) unit *= 2.0;
        return unit;
    }

    /// Where stages are few, dots that will be squared and summed share a stage and so a scale.
    void share_units(const Expr& sum_of_squares) {
        if (m_task.numbers == NumberModel::wide) return;
        std::vector<const Expr*> dots;
        for (const ExprPtr& arg : sum_of_squares.args) {
            if (arg->op != ExprOp::multiply || arg->args[0] != arg->args[1]) return;
            if (arg->args[0]->op != ExprOp::dot || m_lowered.contains(arg->args[0].get())) return;
            dots.push_back(arg->args[0].get());
        }
        double unit = 0.0, wanted = 0.0;
        for (const Expr* d : dots) unit = std::max(unit, unit_of_dot(*d));
        for (const Expr* d : dots) wanted = std::max(wanted, wanted_of(*d));
        for (const Expr* d : dots) {
            m_shared_units[d] = unit;
            m_demand.raise(*d, wanted);
        }
    }

    /// max(0, x): an operand that drops what is negative.
    PlanOperand positive(const Expr& e) {
        if (m_cover.table(e) == nullptr) {
            if (std::optional<PlanOperand> inverse = inverted(e, true)) return *inverse;
        }
        PlanOperand x = lower(e);
        if (m_ranges.of(e).low >= 0.0) return x;
        if (x.input.mapping == Mapping::unsigned_identity ||
            x.input.mapping == Mapping::unsigned_invert)
            return x;
        if (x.input.mapping != Mapping::signed_identity)
            x = m_values.arithmetic(ValueKind::scalar, {x.input, m_values.one(), x.unit}, x.unit);
        x.input.mapping = Mapping::unsigned_identity;
        return x;
    }

    PlanOperand product(const Expr& e) {
        const Expr& a = *e.args[0];
        const Expr& b = *e.args[1];
        if (a.op == ExprOp::constant) {
            PlanOperand x = lower(b);
            x.unit *= std::abs(a.value.x);
            if (a.value.x < 0.0) {
                if (!can_negate(x.input.mapping))
                    x.input = m_values
                                  .arithmetic(ValueKind::scalar, {x.input, m_values.one(), x.unit},
                                              x.unit)
                                  .input;
                x.input.mapping = negated(x.input.mapping);
            }
            return x;
        }
        const PlanProduct p = product_of(e);
        return m_values.arithmetic(ValueKind::scalar, p,
                                   std::min(p.unit, std::max(m_demand.reach(e), 1e-9)));
    }

    PlanProduct product_of(const Expr& e) {
        PlanOperand a = lower(*e.args[0]);
        if (e.args[0] == e.args[1]) {
            // A square's rounding is a share of the square of its unit; stages are there for it.
            const double wanted = wanted_of(*e.args[0]);
            if (m_task.numbers == NumberModel::wide && a.unit > 1.5 * wanted)
                a = m_values.in_units(a, wanted);
            return {a.input, a.input, a.unit * a.unit};
        }
        const PlanOperand b = lower(*e.args[1]);
        return {a.input, b.input, a.unit * b.unit};
    }

    /// A summand: products of the pixel's values come without an operation of their own.
    PlanProduct summand(const Expr& e) {
        const bool is_product = e.op == ExprOp::multiply && m_cover.table(e) == nullptr &&
                                e.args[0]->op != ExprOp::constant && !m_lowered.contains(&e);
        if (is_product) return product_of(e);
        if (e.op == ExprOp::multiply && e.args[0]->op == ExprOp::constant &&
            m_cover.table(e) == nullptr && e.args[1]->op == ExprOp::multiply) {
            PlanProduct p = summand(*e.args[1]);
            p.unit *= std::abs(e.args[0]->value.x);
            if (e.args[0]->value.x < 0.0 && can_negate(p.a.mapping)) {
                p.a.mapping = negated(p.a.mapping);
                return p;
            }
            if (e.args[0]->value.x > 0.0) return p;
        }
        const PlanOperand x = lower(e);
        return {x.input, m_values.one(), x.unit};
    }

    PlanOperand addition(const Expr& e) {
        const Expr& a = *e.args[0];
        const Expr& b = *e.args[1];
        if (std::optional<PlanOperand> inverse = inverted(e, false)) return *inverse;
        share_units(e);
        const double wanted = std::max(m_demand.reach(e), 1e-9);
        PlanProduct p = a.op == ExprOp::constant ? PlanProduct{} : summand(a);
        PlanProduct q = b.op == ExprOp::constant ? PlanProduct{} : summand(b);
        if (a.op == ExprOp::constant) p = constant_summand(a, q.unit, wanted);
        if (b.op == ExprOp::constant) q = constant_summand(b, p.unit, wanted);
        return m_values.sum(ValueKind::scalar, m_values.in_units(p, std::max(p.unit, q.unit)),
                            m_values.in_units(q, std::max(p.unit, q.unit)), wanted);
    }

    PlanProduct constant_summand(const Expr& e, double other_unit, double wanted) {
        const double unit = std::max({std::abs(e.value.x), other_unit, wanted / 2.0});
        return {m_values.constant(e.value.x / unit), m_values.one(), unit};
    }

    /// 1 - x of x >= 0, as an operand: nothing where that is not what a mapping gives.
    /// @param drops_negative  1 - x is wanted only where it is positive
    std::optional<PlanOperand> inverted(const Expr& e, bool drops_negative) {
        if (!is_one_minus(e)) return std::nullopt;
        const Expr& x = *e.args[1]->args[1];
        const Interval range = m_ranges.of(x);
        if (range.low < 0.0 || (range.high > 1.0 + 1e-9 && !drops_negative)) return std::nullopt;
        PlanOperand y = lower(x);
        if (std::abs(y.unit - 1.0) > 1e-9) y = m_values.in_units(y, 1.0);
        if (y.input.mapping != Mapping::signed_identity &&
            y.input.mapping != Mapping::unsigned_identity)
            return std::nullopt;
        return PlanOperand{{y.input.value, Mapping::unsigned_invert}, 1.0};
    }

    /// x of -bound .. bound in units of the bound. What has far larger ones takes a fetch instead
    /// of stages that double.
    PlanOperand clamped(const Expr& e, const Expr& inner, double bound) {
        const PlanOperand x = lower(inner);
        const double staged = m_task.few_stages ? 1.0 : 4.0;
        if (x.unit <= staged * (1.0 + 1e-9) * bound || m_task.numbers == NumberModel::nine_bit)
            return m_values.in_units(x, bound);
        return table_over(e, {&inner}, {{-x.unit, x.unit}});
    }

    // --- tables ---------------------------------------------------------------------------------

    PlanOperand table(const Expr& e) {
        return table_over(e, m_cover.table(e)->args, m_domains.at(&e).arguments);
    }

    PlanOperand table_over(const Expr& e, const std::vector<const Expr*>& args,
                           const std::vector<Interval>& domain) {
        PlanTable t;
        t.function = print_expression(e);
        for (std::size_t i = 0; i < args.size(); ++i) {
            t.axes.push_back(axis(*args[i], domain[i]));
            t.axes.back().name = print_expression(*args[i]);
        }
        if (m_task.table_filter == TableFilter::exact) require_one_computed(t);
        m_tables.fill(t, e, args, domain, m_task.fine_tables ? NumberModel::wide : m_task.numbers);
        PlanValue v;
        v.op = PlanOp::table;
        v.index = static_cast<int>(m_plan.tables.size());
        v.unit = t.unit;
        const bool coded = t.coded;
        m_plan.tables.push_back(std::move(t));
        return {{m_values.add(v), coded ? Mapping::expand : Mapping::signed_identity}, v.unit};
    }

    /// A mean over what two arguments go through is no difference of two sums, and rows of texels
    /// are summed.
    static void require_one_computed(const PlanTable& t) {
        if (t.axes.size() < 2 || (!t.axes[0].of_material && t.axes[1].of_material)) return;
        throw Error(ErrorCode::bad_program,
                    fmt::format("table_filter = exact: the table {} of {} and {}, expected one "
                                "that a pixel computes, then a quantity; mip filters both",
                                t.function, t.axes[0].name, t.axes[1].name));
    }

    /// Coordinates of numbers in `range`.
    static CoordinateRange coordinates(const PlanAxis& axis, const Interval& range) {
        const auto code = [&](double argument) {
            const double x = argument / axis.unit;
            switch (axis.input.mapping) {
                case Mapping::signed_negate:
                    return -x;
                case Mapping::unsigned_invert:
                    return 1.0 - x;
                case Mapping::expand:
                    return 0.5 * x + 0.5;
                case Mapping::expand_negate:
                    return 0.5 - 0.5 * x;
                default:
                    return x;
            }
        };
        const auto within = [](double x) { return static_cast<float>(std::clamp(x, -8.0, 8.0)); };
        const auto [least, most] = std::minmax({code(range.low), code(range.high)});
        return {within(least), within(most)};
    }

    PlanAxis axis(const Expr& arg, const Interval& range) {
        PlanAxis a;
        PlanOperand x = lower(arg);
        a.input = x.input;
        a.unit = x.unit;
        a.is_signed = (x.input.mapping == Mapping::signed_identity && range.low < 0.0) ||
                      (x.input.mapping == Mapping::signed_negate && range.high > 0.0);
        if (a.is_signed && m_task.numbers == NumberModel::nine_bit) {
            // Frames hold no signs: x/2 + 1/2.
            PlanValue v;
            v.products = 2;
            v.factors = {x.input, m_values.constant(0.5), m_values.one(), m_values.constant(0.5)};
            x.input = {m_values.add(v), Mapping::expand};
            a.input = x.input;
            a.is_signed = false;
        }
        a.of_material = arg.op == ExprOp::quantity;
        a.range = coordinates(a, m_ranges.of(arg));
        if (a.of_material) {
            const int index = m_plan.values[static_cast<std::size_t>(x.input.value)].index;
            const PlanQuantity& q = m_plan.quantities[static_cast<std::size_t>(index)];
            if (q.logarithmic) {
                a.logarithmic = true;
                a.low = q.low;
                a.unit = q.unit.x;
            }
        }
        return a;
    }

    const PlanTask& m_task;
    Cover& m_cover;
    Ranges& m_ranges;
    FilledTables& m_tables;
    TableDomains m_domains;
    PlanDemand m_demand;
    Plan m_plan;
    PlanBuilder m_values{m_plan};
    std::map<const Expr*, double, ByAge> m_shared_units;
    std::map<const Expr*, PlanOperand, ByAge> m_lowered;
};

}  // namespace

double PlanAxis::argument(int texel) const {
    return at(size == 1 ? 0.0 : static_cast<double>(texel) / (size - 1));
}

double PlanAxis::between(int texel) const {
    return at((texel + 0.5) / (size - 1));
}

double PlanAxis::at(double position) const {
    const double code = is_signed ? 2.0 * position - 1.0 : position;
    double x = code;
    if (input.mapping == Mapping::signed_negate) x = -code;
    if (input.mapping == Mapping::unsigned_invert) x = 1.0 - code;
    if (input.mapping == Mapping::expand) x = 2.0 * code - 1.0;
    if (input.mapping == Mapping::expand_negate) x = 1.0 - 2.0 * code;
    x *= unit;
    return logarithmic ? dmath::exp2(low + x) : x;
}

Plan make_plan(const PlanTask& task, Cover& cover, Ranges& ranges, FilledTables& tables) {
    return Planner(task, cover, ranges, tables).make();
}

}  // namespace burnish
