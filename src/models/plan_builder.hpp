#pragma once

#include <string>

#include "models/plan.hpp"

namespace burnish {

/// A value as an operand that stands for unit * mapping(code).
struct PlanOperand {
    PlanInput input;
    double unit = 1.0;
};

/// A summand of an operation: a b, in units of `unit`.
struct PlanProduct {
    PlanInput a, b;
    double unit = 1.0;
    bool is_dot = false;
};

/// The mapping of -x; of those that can_negate().
Mapping negated(Mapping mapping);
bool can_negate(Mapping mapping);
double largest(const glm::dvec3& v);

/// Adds values to a plan. A value that is there already is taken again.
class PlanBuilder {
  public:
    explicit PlanBuilder(Plan& plan) : m_plan(plan) {}

    /// Returns its index.
    int add(PlanValue value);
    [[nodiscard]] static PlanInput one() { return {-1, Mapping::unsigned_invert}; }
    PlanInput constant(double value) { return constant(ValueKind::scalar, glm::dvec3(value)); }
    /// Of -1 .. 1, scalars of either sign, colours not negative.
    PlanInput constant(ValueKind kind, const glm::dvec3& value);
    PlanInput input(const std::string& name, ValueKind kind);
    PlanInput quantity(PlanQuantity q);

    /// A product in units as close to `wanted` as no overflow allows.
    PlanOperand arithmetic(ValueKind kind, const PlanProduct& p, double wanted);
    /// Two that have the same units.
    PlanOperand sum(ValueKind kind, const PlanProduct& p, const PlanProduct& q, double wanted);
    /// The same value in other units: exactly those, where a register may stop at 1 for it.
    PlanOperand in_units(PlanOperand x, double unit, ValueKind kind = ValueKind::scalar);
    /// The same summand in larger units.
    PlanProduct in_units(const PlanProduct& p, double unit);

    /// Whether an operand may be negative.
    [[nodiscard]] bool is_signed(const PlanInput& i) const;

  private:
    [[nodiscard]] bool is_signed(const PlanValue& v) const;

    Plan& m_plan;
};

}  // namespace burnish
