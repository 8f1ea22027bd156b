#include "models/plan_demand.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace burnish {

namespace {

constexpr double kAll = std::numeric_limits<double>::infinity();

/// Where a term is white, whatever its hue.
double white(const PlanTask& task, const ModelTerm& term) {
    const glm::dvec3 k = glm::abs(task.light * term.factor);
    const double least = std::min({k.x, k.y, k.z});
    return term.color || least <= 0.0 ? kAll : 1.0 / least;
}

}  // namespace

PlanDemand::PlanDemand(const PlanTask& task, Cover& cover, Ranges& ranges,
                       const TableDomains& domains)
    : m_cover(cover), m_ranges(ranges), m_domains(domains) {
    for (const ModelTerm& term : *task.terms)
        if (term.scalar) demand(*term.scalar, white(task, term), -kAll);
}

void PlanDemand::demand(const Expr& e, double reach, double from) {
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
            if (const Expr* inner = symmetric_clamp(e)) return demand(*inner, e.args[1]->value.x);
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

double PlanDemand::reach(const Expr& e) {
    const Interval range = m_ranges.of(e);
    const double whole = std::max(std::abs(range.low), std::abs(range.high));
    const auto at = m_reach.find(&e);
    return at == m_reach.end() ? whole : std::min(at->second, whole);
}

void PlanDemand::raise(const Expr& e, double reach) {
    double& known = m_reach[&e];
    known = std::max(known, reach);
}

}  // namespace burnish
