#include "models/plan_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace burnish {

namespace {

bool same(const PlanValue& a, const PlanValue& b) {
    return a.op == b.op && a.kind == b.kind && a.unit == b.unit && a.name == b.name &&
           a.index == b.index && a.constant == b.constant && a.factors == b.factors &&
           a.products == b.products && a.is_dot == b.is_dot && a.doublings == b.doublings;
}

/// Powers of two that bring a result in units of `unit` as close to `wanted` as no overflow
/// allows.
int doublings(double unit, double wanted) {
    int k = 2;
    while (k > -1 && std::ldexp(unit, -k) < wanted * (1.0 - 1e-9)) --k;
    return k;
}

}  // namespace

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

bool PlanBuilder::is_signed(const PlanInput& i) const {
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

bool PlanBuilder::is_signed(const PlanValue& v) const {
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

int PlanBuilder::add(PlanValue value) {
    value.is_signed = is_signed(value);
    for (std::size_t i = 0; i < m_plan.values.size(); ++i) {
        if (same(m_plan.values[i], value)) return static_cast<int>(i);
    }
    m_plan.values.push_back(std::move(value));
    return static_cast<int>(m_plan.values.size()) - 1;
}

PlanInput PlanBuilder::constant(ValueKind kind, const glm::dvec3& value) {
    if (value == glm::dvec3(1.0)) return {-1, Mapping::unsigned_invert};
    if (kind == ValueKind::scalar && value.x < 0.0)
        return {constant(-value.x).value, Mapping::signed_negate};
    PlanValue v;
    v.op = PlanOp::constant;
    v.kind = kind;
    v.constant = value;
    return {add(v), Mapping::signed_identity};
}

PlanInput PlanBuilder::input(const std::string& name, ValueKind kind) {
    PlanValue v;
    v.op = PlanOp::input;
    v.kind = kind;
    v.name = name;
    return {add(v), kind == ValueKind::vector ? Mapping::expand : Mapping::signed_identity};
}

PlanInput PlanBuilder::quantity(PlanQuantity q) {
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

PlanOperand PlanBuilder::arithmetic(ValueKind kind, const PlanProduct& p, double wanted) {
    PlanValue v;
    v.kind = kind;
    v.factors[0] = p.a;
    v.factors[1] = p.b;
    v.is_dot = p.is_dot;
    v.doublings = std::max(doublings(p.unit, wanted), 0);
    v.unit = std::ldexp(p.unit, -v.doublings);
    return {{add(v), Mapping::signed_identity}, v.unit};
}

PlanOperand PlanBuilder::sum(ValueKind kind, const PlanProduct& p, const PlanProduct& q,
                             double wanted) {
    PlanValue v;
    v.kind = kind;
    v.products = 2;
    v.factors = {p.a, p.b, q.a, q.b};
    v.doublings = doublings(p.unit, wanted);
    v.unit = std::ldexp(p.unit, -v.doublings);
    return {{add(v), Mapping::signed_identity}, v.unit};
}

PlanOperand PlanBuilder::in_units(PlanOperand x, double unit, ValueKind kind) {
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

PlanProduct PlanBuilder::in_units(const PlanProduct& p, double unit) {
    if (p.unit > unit * (1.0 - 1e-9)) return p;
    const double ratio = p.unit / unit;
    if (p.b == one()) return {p.a, constant(ratio), unit};
    const PlanOperand x = arithmetic(ValueKind::scalar, p, p.unit);
    return {x.input, constant(ratio), unit};
}

}  // namespace burnish
