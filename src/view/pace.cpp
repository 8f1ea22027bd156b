#include "view/pace.hpp"

#include <algorithm>
#include <cmath>

namespace burnish::view {
namespace {

constexpr double kMostDivisor = 16.0;
constexpr double kSteps = 8.0;
/// Fixed costs beyond this share of the budget: a smaller picture would not help.
constexpr double kMostFixed = 0.5;

/// Follows what is measured, half of the way.
double followed(double known, double now) {
    return 0.5 * (known + now);
}

}  // namespace

void Pace::took(const std::string& machine, double pixels, double ms, double fixed_ms) {
    const double now = 1e6 * std::max(ms - fixed_ms, 0.0) / std::max(pixels, 1.0);
    const auto [known, is_first] = m_costs.try_emplace(machine, Cost{fixed_ms, now});
    if (is_first) return;
    known->second.fixed_ms = followed(known->second.fixed_ms, fixed_ms);
    known->second.ns_per_pixel = followed(known->second.ns_per_pixel, now);
}

double Pace::divisor(const std::string& machine, double pixels, int shares, double guess_ns) const {
    const auto known = m_costs.find(machine);
    const Cost cost = known == m_costs.end() ? Cost{0.0, guess_ns} : known->second;
    const double budget = m_budget_ms / shares;
    const double allowed = 1e6 * (budget - std::min(cost.fixed_ms, kMostFixed * budget));
    const double ratio = std::sqrt(pixels * cost.ns_per_pixel / allowed);
    return std::clamp(std::ceil(kSteps * ratio - 1e-9) / kSteps, 1.0, kMostDivisor);
}

}  // namespace burnish::view
