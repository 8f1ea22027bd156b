#pragma once

#include <limits>
#include <map>

#include "models/cover.hpp"
#include "models/make_plan.hpp"
#include "models/table_domain.hpp"

namespace burnish {

using TableDomains = std::map<const Expr*, TableDomain, ByAge>;

/// How far values need to reach for the light that is seen of them; what lies beyond may stop, so
/// that registers of -1 .. 1 have more digits for the rest.
class PlanDemand {
  public:
    PlanDemand(const PlanTask& task, Cover& cover, Ranges& ranges, const TableDomains& domains);

    /// The largest |value| that is wanted of `e`.
    double reach(const Expr& e);
    /// At least `reach` from now on.
    void raise(const Expr& e, double reach);
    /// All expressions that were asked for, however far they go.
    [[nodiscard]] const std::map<const Expr*, double, ByAge>& reaches() const { return m_reach; }

  private:
    /// `e` is wanted up to `reach`, and only from `from` on; beyond, it may stop.
    void demand(const Expr& e, double reach,
                double from = -std::numeric_limits<double>::infinity());

    Cover& m_cover;
    Ranges& m_ranges;
    const TableDomains& m_domains;
    std::map<const Expr*, double, ByAge> m_reach;
};

}  // namespace burnish
