#include "view/pace.hpp"

#include <algorithm>
#include <cmath>

namespace burnish::view {
namespace {

/// Before anything was measured: small at first, since a long frame cannot be taken back.
constexpr double kUnknownNsPerPixel = 200.0;
constexpr int kMostDivisor = 16;

}  // namespace

void Pace::took(const std::string& machine, double pixels, double ms) {
    const double now = 1e6 * ms / std::max(pixels, 1.0);
    const auto known = m_ns_per_pixel.find(machine);
    // Slower at once, faster only little by little: sizes that go back and forth disturb.
    if (known == m_ns_per_pixel.end())
        m_ns_per_pixel.emplace(machine, now);
    else
        known->second = std::max(now, 0.8 * known->second + 0.2 * now);
}

int Pace::divisor(const std::string& machine, double pixels, int shares) const {
    const auto known = m_ns_per_pixel.find(machine);
    const double each = known == m_ns_per_pixel.end() ? kUnknownNsPerPixel : known->second;
    const double allowed = 1e6 * m_budget_ms / shares;
    const double ratio = std::sqrt(pixels * each / allowed);
    return std::clamp(static_cast<int>(std::ceil(ratio - 1e-9)), 1, kMostDivisor);
}

}  // namespace burnish::view
