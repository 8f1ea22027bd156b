#include "models/make_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "core/dmath.hpp"
#include "models/model_needs.hpp"
#include "models/table_domain.hpp"

namespace burnish {

namespace {

/// A value as an operand that stands for unit * mapping(code).
struct Operand {
    PlanInput input;
    double unit = 1.0;
};

/// A summand of an operation: a b, in units of `unit`.
struct Product {
    PlanInput a, b;
    double unit = 1.0;
    bool is_dot = false;
};

Mapping negated(Mapping m) {
    switch (m) {
        case Mapping::signed_identity:
            return Mapping::signed_negate;
        case Mapping::signed_negate:
            return Mapping::signed_identity;
        case Mapping::expand:
            return Mapping::expand_negate;
        default:
            return Mapping::expand;
    }
}
bool can_negate(Mapping m) {
    return m != Mapping::unsigned_identity && m != Mapping::unsigned_invert;
}

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

bool is_half_vector(const Expr& e) {
    return e.op == ExprOp::geometry && e.name == "h";
}

constexpr double kAll = std::numeric_limits<double>::infinity();

class Planner {
  public:
    Planner(const PlanTask& task, Cover& cover, Ranges& ranges, FilledTables& tables)
        : m_task(task), m_cover(cover), m_ranges(ranges), m_tables(tables) {}

    Plan make() {
        for (const Expr* e : m_cover.tables()) {
            m_domains.emplace(e,
                              table_domain(*e, m_cover.table(*e)->args, m_ranges, m_task.numbers));
        }
        for (const ModelTerm& term : *m_task.terms) {
            if (term.scalar) demand(*term.scalar, white(term));
        }
        scale_half_vector();
        finish();
        return std::move(m_plan);
    }

  private:
    // --- how far values need to reach ---------------------------------------------------------

    /// Where a term is white, whatever its hue.
    double white(const ModelTerm& term) const {
        const glm::dvec3 k = glm::abs(m_task.light * term.factor);
        const double least = std::min({k.x, k.y, k.z});
        return term.color || least <= 0.0 ? kAll : 1.0 / least;
    }

    /// `e` is wanted up to `reach`, and only from `from` on; beyond, it may stop.
    void demand(const Expr& e, double reach, double from = -kAll) {
        if (e.kind != ValueKind::scalar || e.op == ExprOp::constant) return;
        const auto [at, is_new] = m_reach.emplace(&e, reach);
        if (!is_new && at->second >= reach) return;
        at->second = reach;
        if (m_cover.table(e) != nullptr) {
            const std::vector<const Expr*>& args = m_cover.table(e)->args;
            for (std::size_t i = 0; i < args.size(); ++i) {
                const Interval& domain = m_domains.at(&e).arguments[i];
                demand(*args[i], domain.high, domain.low);
            }
            return;
        }
        const auto low = [&](std::size_t i) { return m_ranges.of(*e.args[i]).low; };
        switch (e.op) {
            case ExprOp::add:
                // x - y with y >= 0 is below `from` once y is beyond high(x) - from.
                if (is_negation(*e.args[1]) && m_ranges.of(*e.args[1]).high <= 0.0) {
                    demand(*e.args[0], kAll, from);
                    demand(*e.args[1]->args[1], m_ranges.of(*e.args[0]).high - from);
                    return;
                }
                // Of summands that are not negative each may stop where the sum does.
                for (const ExprPtr& arg : e.args)
                    demand(*arg, low(0) >= 0.0 && low(1) >= 0.0 ? reach : kAll);
                return;
            case ExprOp::multiply:
                if (e.args[0] == e.args[1]) {
                    demand(*e.args[0], std::sqrt(reach));
                } else if (e.args[0]->op == ExprOp::constant) {
                    demand(*e.args[1], reach / std::abs(e.args[0]->value.x));
                } else {
                    // What the other factor makes larger is wanted less far.
                    for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
                        demand(*e.args[i], low(1 - i) > 0.0 ? reach / low(1 - i) : kAll);
                }
                return;
            case ExprOp::maximum:
                for (const ExprPtr& arg : e.args) {
                    if (m_cover.table(*arg) == nullptr && is_one_minus(*arg)) {
                        demand(*arg->args[1]->args[1], 1.0);
                    } else {
                        demand(*arg, reach);
                    }
                }
                return;
            case ExprOp::minimum:
                if (const Expr* inner = symmetric_clamp(e))
                    return demand(*inner, e.args[1]->value.x);
                for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
                    const Expr& bound = *e.args[1 - i];
                    if (bound.op == ExprOp::constant) demand(*e.args[i], bound.value.x);
                }
                return;
            case ExprOp::power:
                return demand(*e.args[0], kAll);
            default:
                return;
        }
    }

    double reach(const Expr& e) {
        const Interval range = m_ranges.of(e);
        const double whole = std::max(std::abs(range.low), std::abs(range.high));
        const auto at = m_reach.find(&e);
        return at == m_reach.end() ? whole : std::min(at->second, whole);
    }

    /// Lobes about the normal end where their tangent vectors say so: within an ellipse, whose box
    /// bounds x and y of the half vector. What is clamped to the box is not inside the ellipse, so
    /// x and y can have the digits that the box leaves free.
    void scale_half_vector() {
        if (!m_task.scaled_half_vector) return;
        glm::dvec3 box(m_task.most_tilt);
        std::vector<glm::dvec3> axes;
        for (const auto& [e, reach] : m_reach) {
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

    // --- values ---------------------------------------------------------------------------------

    /// Whether an operand may be negative.
    bool is_signed(const PlanInput& i) const {
        switch (i.mapping) {
            case Mapping::unsigned_identity:
            case Mapping::unsigned_invert:
                return false;
            case Mapping::signed_identity:
                return i.value >= 0 && m_plan.values[static_cast<std::size_t>(i.value)].is_signed;
            default:
                return true;
        }
    }
    bool is_signed(const PlanValue& v) const {
        switch (v.op) {
            case PlanOp::input:
            case PlanOp::quantity:
                return v.kind == ValueKind::vector;
            case PlanOp::constant:
                return false;
            case PlanOp::table:
                return m_plan.tables[static_cast<std::size_t>(v.index)].coded;
            case PlanOp::arithmetic:
                break;
        }
        if (v.is_dot) return true;
        for (int k = 0; k < v.products; ++k) {
            const PlanInput& a = v.factors[static_cast<std::size_t>(2 * k)];
            const PlanInput& b = v.factors[static_cast<std::size_t>(2 * k + 1)];
            if (a != b && (is_signed(a) || is_signed(b))) return true;
        }
        return false;
    }

    int add(PlanValue value) {
        value.is_signed = is_signed(value);
        for (std::size_t i = 0; i < m_plan.values.size(); ++i) {
            if (same(m_plan.values[i], value)) return static_cast<int>(i);
        }
        m_plan.values.push_back(std::move(value));
        return static_cast<int>(m_plan.values.size()) - 1;
    }
    static bool same(const PlanValue& a, const PlanValue& b) {
        return a.op == b.op && a.kind == b.kind && a.unit == b.unit && a.name == b.name &&
               a.index == b.index && a.constant == b.constant && a.factors == b.factors &&
               a.products == b.products && a.is_dot == b.is_dot && a.doublings == b.doublings;
    }

    PlanInput constant(double value) { return constant(ValueKind::scalar, glm::dvec3(value)); }
    /// Of -1 .. 1, scalars of either sign, colours not negative.
    PlanInput constant(ValueKind kind, const glm::dvec3& value) {
        if (value == glm::dvec3(1.0)) return {-1, Mapping::unsigned_invert};
        if (kind == ValueKind::scalar && value.x < 0.0)
            return {constant(-value.x).value, Mapping::signed_negate};
        PlanValue v;
        v.op = PlanOp::constant;
        v.kind = kind;
        v.constant = value;
        return {add(v), Mapping::signed_identity};
    }
    PlanInput one() { return {-1, Mapping::unsigned_invert}; }

    PlanInput input(const std::string& name, ValueKind kind) {
        PlanValue v;
        v.op = PlanOp::input;
        v.kind = kind;
        v.name = name;
        return {add(v), kind == ValueKind::vector ? Mapping::expand : Mapping::signed_identity};
    }

    PlanInput quantity(PlanQuantity q) {
        std::size_t i = 0;
        while (i < m_plan.quantities.size() &&
               !(m_plan.quantities[i].expr == q.expr && m_plan.quantities[i].unit == q.unit))
            ++i;
        PlanValue v;
        v.op = PlanOp::quantity;
        v.kind = q.kind;
        v.index = static_cast<int>(i);
        const bool coded = q.is_coded();
        if (i == m_plan.quantities.size()) m_plan.quantities.push_back(std::move(q));
        return {add(v), coded ? Mapping::expand : Mapping::signed_identity};
    }

    /// Powers of two that bring a result in units of `unit` as close to `wanted` as no overflow
    /// allows.
    static int doublings(double unit, double wanted) {
        int k = 2;
        while (k > -1 && std::ldexp(unit, -k) < wanted * (1.0 - 1e-9)) --k;
        return k;
    }

    Operand arithmetic(ValueKind kind, const Product& p, double wanted) {
        PlanValue v;
        v.kind = kind;
        v.factors[0] = p.a;
        v.factors[1] = p.b;
        v.is_dot = p.is_dot;
        v.doublings = std::max(doublings(p.unit, wanted), 0);
        v.unit = std::ldexp(p.unit, -v.doublings);
        return {{add(v), Mapping::signed_identity}, v.unit};
    }

    Operand sum(ValueKind kind, const Product& p, const Product& q, double wanted) {
        PlanValue v;
        v.kind = kind;
        v.products = 2;
        v.factors = {p.a, p.b, q.a, q.b};
        v.doublings = doublings(p.unit, wanted);
        v.unit = std::ldexp(p.unit, -v.doublings);
        return {{add(v), Mapping::signed_identity}, v.unit};
    }

    /// The same value in other units: exactly those, where a register may stop at 1 for it.
    Operand in_units(Operand x, double unit, ValueKind kind = ValueKind::scalar) {
        while (x.unit > unit * (1.0 + 1e-9)) {
            // A factor at most 1 that leaves a power of two, at most 4.
            double rest = x.unit / unit;
            int k = 0;
            while (rest > 1.0 + 1e-9 && k < 2) {
                rest /= 2.0;
                ++k;
            }
            if (rest > 1.0) rest = 1.0;
            PlanValue v;
            v.kind = kind;
            v.factors[0] = x.input;
            v.factors[1] = constant(rest);
            v.doublings = k;
            v.unit = std::ldexp(x.unit, -k) / rest;
            x = {{add(v), Mapping::signed_identity}, v.unit};
        }
        if (x.unit < unit * (1.0 - 1e-9)) {
            PlanValue v;
            v.kind = kind;
            v.factors[0] = x.input;
            v.factors[1] = constant(x.unit / unit);
            v.unit = unit;
            x = {{add(v), Mapping::signed_identity}, unit};
        }
        return x;
    }

    // --- expressions ----------------------------------------------------------------------------

    Operand lower(const Expr& e) {
        const auto at = m_lowered.find(&e);
        if (at != m_lowered.end()) return at->second;
        const Operand made = m_cover.table(e) != nullptr ? table(e) : computed(e);
        m_lowered.emplace(&e, made);
        return made;
    }

    Operand computed(const Expr& e) {
        switch (e.op) {
            case ExprOp::constant:
                return {constant(e.value.x < 0.0 ? -1.0 : 1.0), std::abs(e.value.x)};
            case ExprOp::geometry:
                return {input(e.name, ValueKind::scalar), 1.0};
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
                return in_units(lower(first ? *e.args[1] : *e.args[0]), bound.value.x);
            }
            case ExprOp::power: {
                if (e.args[1]->op != ExprOp::constant || squarings(e.args[1]->value.x) < 0)
                    needs_table(e);
                Operand x = lower(*e.args[0]);
                for (int k = squarings(e.args[1]->value.x); k > 0; --k) {
                    const double unit = x.unit * x.unit;
                    x = arithmetic(ValueKind::scalar, {x.input, x.input, unit}, unit);
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

    Operand scalar_quantity(const Expr& e) {
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
            return {quantity(q), 1.0};
        }
        q.is_signed = values.low.x < 0.0;
        q.unit = glm::dvec3(std::max({values.high.x, -values.low.x, 1e-6}));
        return {quantity(q), q.unit.x};
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

    Operand dot(const Expr& e) {
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
        return arithmetic(ValueKind::scalar,
                          {input(pixel.name, ValueKind::vector), quantity(q), unit, true}, wanted);
    }
    /// Constants hold no signs: those of a vector that has negative components are coded like it.
    Operand dot_with_constant(const Expr& pixel, const glm::dvec3& v, double wanted) {
        const glm::dvec3 q = v / scale_of(pixel);
        const double unit = largest(glm::abs(q));
        const bool is_negative = std::min({q.x, q.y, q.z}) < 0.0;
        PlanInput constant_vector =
            constant(ValueKind::color, is_negative ? 0.5 * (q / unit) + 0.5 : q / unit);
        if (is_negative) constant_vector.mapping = Mapping::expand;
        return arithmetic(ValueKind::scalar,
                          {input(pixel.name, ValueKind::vector), constant_vector, unit, true},
                          wanted);
    }
    double wanted_of(const Expr& e) { return std::max(reach(e), 1e-6); }
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
            m_reach[d] = std::max(m_reach[d], wanted);
        }
    }

    /// max(0, x): an operand that drops what is negative.
    Operand positive(const Expr& e) {
        if (m_cover.table(e) == nullptr) {
            if (std::optional<Operand> inverse = inverted(e, true)) return *inverse;
        }
        Operand x = lower(e);
        if (m_ranges.of(e).low >= 0.0) return x;
        if (x.input.mapping == Mapping::unsigned_identity ||
            x.input.mapping == Mapping::unsigned_invert)
            return x;
        if (x.input.mapping != Mapping::signed_identity)
            x = arithmetic(ValueKind::scalar, {x.input, one(), x.unit}, x.unit);
        x.input.mapping = Mapping::unsigned_identity;
        return x;
    }

    Operand product(const Expr& e) {
        const Expr& a = *e.args[0];
        const Expr& b = *e.args[1];
        if (a.op == ExprOp::constant) {
            Operand x = lower(b);
            x.unit *= std::abs(a.value.x);
            if (a.value.x < 0.0) {
                if (!can_negate(x.input.mapping))
                    x.input = arithmetic(ValueKind::scalar, {x.input, one(), x.unit}, x.unit).input;
                x.input.mapping = negated(x.input.mapping);
            }
            return x;
        }
        const Product p = product_of(e);
        return arithmetic(ValueKind::scalar, p, std::min(p.unit, std::max(reach(e), 1e-9)));
    }

    Product product_of(const Expr& e) {
        Operand a = lower(*e.args[0]);
        if (e.args[0] == e.args[1]) {
            // A square's rounding is a share of the square of its unit; stages are there for it.
            const double wanted = wanted_of(*e.args[0]);
            if (m_task.numbers == NumberModel::wide && a.unit > 1.5 * wanted)
                a = in_units(a, wanted);
            return {a.input, a.input, a.unit * a.unit};
        }
        const Operand b = lower(*e.args[1]);
        return {a.input, b.input, a.unit * b.unit};
    }

    /// A summand: products of the pixel's values come without an operation of their own.
    Product summand(const Expr& e) {
        const bool is_product = e.op == ExprOp::multiply && m_cover.table(e) == nullptr &&
                                e.args[0]->op != ExprOp::constant && !m_lowered.contains(&e);
        if (is_product) return product_of(e);
        if (e.op == ExprOp::multiply && e.args[0]->op == ExprOp::constant &&
            m_cover.table(e) == nullptr && e.args[1]->op == ExprOp::multiply) {
            Product p = summand(*e.args[1]);
            p.unit *= std::abs(e.args[0]->value.x);
            if (e.args[0]->value.x < 0.0 && can_negate(p.a.mapping)) {
                p.a.mapping = negated(p.a.mapping);
                return p;
            }
            if (e.args[0]->value.x > 0.0) return p;
        }
        const Operand x = lower(e);
        return {x.input, one(), x.unit};
    }

    Operand addition(const Expr& e) {
        const Expr& a = *e.args[0];
        const Expr& b = *e.args[1];
        if (std::optional<Operand> inverse = inverted(e, false)) return *inverse;
        share_units(e);
        const double wanted = std::max(reach(e), 1e-9);
        Product p = a.op == ExprOp::constant ? Product{} : summand(a);
        Product q = b.op == ExprOp::constant ? Product{} : summand(b);
        if (a.op == ExprOp::constant) p = constant_summand(a, q.unit, wanted);
        if (b.op == ExprOp::constant) q = constant_summand(b, p.unit, wanted);
        return sum(ValueKind::scalar, in_units(p, std::max(p.unit, q.unit)),
                   in_units(q, std::max(p.unit, q.unit)), wanted);
    }

    Product constant_summand(const Expr& e, double other_unit, double wanted) {
        const double unit = std::max({std::abs(e.value.x), other_unit, wanted / 2.0});
        return {constant(e.value.x / unit), one(), unit};
    }

    /// The same summand in larger units.
    Product in_units(const Product& p, double unit) {
        if (p.unit > unit * (1.0 - 1e-9)) return p;
        const double ratio = p.unit / unit;
        if (p.b == one()) return {p.a, constant(ratio), unit};
        const Operand x = arithmetic(ValueKind::scalar, p, p.unit);
        return {x.input, constant(ratio), unit};
    }

    /// 1 - x of x >= 0, as an operand: nothing where that is not what a mapping gives.
    /// @param drops_negative  1 - x is wanted only where it is positive
    std::optional<Operand> inverted(const Expr& e, bool drops_negative) {
        if (!is_one_minus(e)) return std::nullopt;
        const Expr& x = *e.args[1]->args[1];
        const Interval range = m_ranges.of(x);
        if (range.low < 0.0 || (range.high > 1.0 + 1e-9 && !drops_negative)) return std::nullopt;
        Operand y = lower(x);
        if (std::abs(y.unit - 1.0) > 1e-9) y = in_units(y, 1.0);
        if (y.input.mapping != Mapping::signed_identity &&
            y.input.mapping != Mapping::unsigned_identity)
            return std::nullopt;
        return Operand{{y.input.value, Mapping::unsigned_invert}, 1.0};
    }

    /// x of -bound .. bound in units of the bound. What has far larger ones takes a fetch instead
    /// of stages that double.
    Operand clamped(const Expr& e, const Expr& inner, double bound) {
        const Operand x = lower(inner);
        const double staged = m_task.few_stages ? 1.0 : 4.0;
        if (x.unit <= staged * (1.0 + 1e-9) * bound || m_task.numbers == NumberModel::nine_bit)
            return in_units(x, bound);
        return table_over(e, {&inner}, {{-x.unit, x.unit}});
    }

    // --- tables ---------------------------------------------------------------------------------

    Operand table(const Expr& e) {
        return table_over(e, m_cover.table(e)->args, m_domains.at(&e).arguments);
    }

    Operand table_over(const Expr& e, const std::vector<const Expr*>& args,
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
        return {{add(v), coded ? Mapping::expand : Mapping::signed_identity}, v.unit};
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
        Operand x = lower(arg);
        a.input = x.input;
        a.unit = x.unit;
        a.is_signed = (x.input.mapping == Mapping::signed_identity && range.low < 0.0) ||
                      (x.input.mapping == Mapping::signed_negate && range.high > 0.0);
        if (a.is_signed && m_task.numbers == NumberModel::nine_bit) {
            // Frames hold no signs: x/2 + 1/2.
            PlanValue v;
            v.products = 2;
            v.factors = {x.input, constant(0.5), one(), constant(0.5)};
            x.input = {add(v), Mapping::expand};
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

    // --- light
    // ------------------------------------------------------------------------------------

    /// What varies of a term's colour.
    Operand color(const Expr& e) {
        if (e.op == ExprOp::multiply) {
            const Operand a = color(*e.args[0]);
            const Operand b = color(*e.args[1]);
            return arithmetic(ValueKind::color, {a.input, b.input, a.unit * b.unit},
                              a.unit * b.unit);
        }
        const QuantityValues& values = m_task.quantities.at(&e);
        PlanQuantity q{.name = e.name, .expr = &e, .kind = ValueKind::color, .unit = {}};
        q.unit = glm::dvec3(std::max(largest(values.high), 1e-6));
        return {quantity(q), q.unit.x};
    }

    /// A term with its light as a product that is right in units of `unit`, a power of two.
    Product lit(const ModelTerm& term) {
        Operand x = term.scalar ? lower(*term.scalar) : Operand{one(), 1.0};
        if (term.color) {
            const Operand c = color(*term.color);
            const double unit = x.unit * c.unit;
            x = term.scalar ? arithmetic(ValueKind::color, {x.input, c.input, unit}, unit) : c;
        }
        const glm::dvec3 k = m_task.light * term.factor * x.unit;
        const bool negative = k.x < 0.0 || k.y < 0.0 || k.z < 0.0;
        if (negative && (k.x > 0.0 || k.y > 0.0 || k.z > 0.0))
            throw Error(ErrorCode::bad_program, "a colour of both signs, expected one sign a term");
        const double most = largest(glm::abs(k));
        double unit = 1.0;
        while (unit < most * (1.0 - 1e-9) && unit < 4.0) unit *= 2.0;
        if (most > 4.0) {
            x = in_units(x, x.unit * 4.0 / most, term.color ? ValueKind::color : ValueKind::scalar);
            unit = 4.0;
        }
        PlanInput factor =
            constant(ValueKind::color, glm::abs(m_task.light * term.factor * x.unit) / unit);
        if (negative) factor.mapping = factor == one() ? Mapping::expand : Mapping::signed_negate;
        return {x.input, factor, unit};
    }

    Product in_color_units(Product p, double unit) {
        if (p.unit == unit) return p;
        const Operand x = arithmetic(ValueKind::color, p, p.unit);
        return {x.input, constant(p.unit / unit), unit};
    }

    /// The final combiner takes the last product, and one more inside it; the rest is summed
    /// before.
    void finish() {
        glm::dvec3 base = m_task.ambient;
        std::vector<Product> products;
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
                                       [&](const Product& p) { return fits_final(p); });
        if (last != products.end()) {
            final_product(*last);
            products.erase(last);
        }
        if (m_plan.lit_tint != glm::dvec3(0.0)) {
            m_plan.lit_base = base;
            const PlanInput lit_input = input("lit", ValueKind::color);
            if (products.empty()) {
                m_plan.final.d = lit_input;
                return;
            }
            products.push_back({lit_input, one(), 1.0});
        } else if (base != glm::dvec3(0.0)) {
            const PlanInput constant_base = constant(ValueKind::color, base);
            if (products.empty()) {
                m_plan.final.d = constant_base;
                return;
            }
            products.push_back({constant_base, one(), 1.0});
        }
        if (!products.empty()) m_plan.final.d = summed(products);
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
    bool fits_final(const Product& p) const {
        return p.unit == 1.0 && !is_signed(p.a) && !is_signed(p.b);
    }

    /// Three factors multiply in the final combiner; of more, those that are known first have been
    /// multiplied before.
    void final_product(const Product& p) {
        std::vector<PlanInput> factors = factors_of(p.a);
        if (p.b != one()) factors.push_back(p.b);
        while (factors.size() > 3) {
            std::stable_sort(
                factors.begin(), factors.end(),
                [&](const PlanInput& x, const PlanInput& y) { return depth_of(x) < depth_of(y); });
            const ValueKind kind = std::max(kind_of(factors[0]), kind_of(factors[1]));
            factors[1] = arithmetic(kind, {factors[0], factors[1], 1.0}, 1.0).input;
            factors.erase(factors.begin());
        }
        PlanFinal& f = m_plan.final;
        f.a = factors[0];
        f.b = factors.size() == 2 ? factors[1] : one();
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
                            v.doublings == 0 && !is_signed(v.factors[0]) &&
                            !is_signed(v.factors[1]);
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

    PlanInput summed(const std::vector<Product>& products) {
        if (products.size() == 1 && products[0].b == one() && products[0].unit == 1.0)
            return products[0].a;
        std::optional<Operand> sum_so_far;
        for (std::size_t i = 0; i < products.size();) {
            if (sum_so_far) {
                const double unit = std::max(products[i].unit, 1.0);
                sum_so_far =
                    sum(ValueKind::color, in_color_units({sum_so_far->input, one(), 1.0}, unit),
                        in_color_units(products[i], unit), 1.0);
                i += 1;
            } else if (i + 1 < products.size()) {
                const double unit = std::max(products[i].unit, products[i + 1].unit);
                sum_so_far = sum(ValueKind::color, in_color_units(products[i], unit),
                                 in_color_units(products[i + 1], unit), 1.0);
                i += 2;
            } else {
                sum_so_far = arithmetic(ValueKind::color, products[i], 1.0);
                i += 1;
            }
        }
        return sum_so_far->input;
    }

    static bool is_negation(const Expr& e) {
        return e.op == ExprOp::multiply && is_number(*e.args[0], -1.0);
    }
    static bool is_one_minus(const Expr& e) {
        return e.op == ExprOp::add && is_number(*e.args[0], 1.0) &&
               e.args[1]->op == ExprOp::multiply && is_number(*e.args[1]->args[0], -1.0);
    }

    const PlanTask& m_task;
    Cover& m_cover;
    Ranges& m_ranges;
    FilledTables& m_tables;
    Plan m_plan;
    std::map<const Expr*, TableDomain, ByAge> m_domains;
    std::map<const Expr*, double, ByAge> m_reach, m_shared_units;
    std::map<const Expr*, Operand, ByAge> m_lowered;
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
