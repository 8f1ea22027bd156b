#include "reference/power_filter.hpp"

#include <algorithm>
#include <cmath>

namespace burnish::reference {

namespace {

double power(double s, double m) {
    const double base = std::max(s, 0.0);
    return m == 2.0 ? base * base : std::pow(base, m);
}

/// Texel `at` of a level: the mean of the values below it.
double texel(int level, int at, double m) {
    const int span = 1 << level;
    double sum = 0.0;
    for (int i = at * span; i < (at + 1) * span; ++i) sum += power(i / (kPowerTexels - 1.0), m);
    return sum / span;
}

double in_level(int level, double s, double m) {
    const int last = (kPowerTexels >> level) - 1;
    // Centres of level 0 lie at integers.
    const double place = (s * (kPowerTexels - 1.0) + 0.5) / (1 << level) - 0.5;
    const double kept = std::clamp(place, 0.0, static_cast<double>(last));
    const int first = static_cast<int>(kept);
    const double weight = kept - first;
    if (weight == 0.0) return texel(level, first, m);
    return texel(level, first, m) * (1.0 - weight) + texel(level, first + 1, m) * weight;
}

}  // namespace

double mean_power(double low, double high, double m) {
    // Of a short interval the middle is the mean to more digits than the difference has.
    if (high - low < 1e-7) return power(0.5 * (low + high), m);
    return (power(high, m + 1.0) - power(low, m + 1.0)) / ((m + 1.0) * (high - low));
}

double mip_power(double s, double step, double m) {
    const int last = static_cast<int>(std::log2(kPowerTexels));
    const double lambda = step > 0.0 ? std::log2(kPowerTexels * step) : 0.0;
    const double level = std::clamp(lambda, 0.0, static_cast<double>(last));
    const int first = static_cast<int>(level);
    const double weight = level - first;
    if (weight == 0.0) return in_level(first, s, m);
    return in_level(first, s, m) * (1.0 - weight) + in_level(first + 1, s, m) * weight;
}

double PowerFilter::operator()(double s, double m) const {
    switch (kind) {
        case TableFilter::point:
            break;
        case TableFilter::mip:
            return mip_power(s, step, m);
        case TableFilter::exact:
            // There is nothing beyond h = n.
            return mean_power(s - 0.5 * step, std::max(std::min(s + 0.5 * step, 1.0), s), m);
    }
    return power(s, m);
}

}  // namespace burnish::reference
