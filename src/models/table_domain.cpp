#include "models/table_domain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/dmath.hpp"
#include "models/table_function.hpp"

namespace burnish {

namespace {

constexpr int kSteps = 160, kOthers = 9;

/// Steps that grow with the distance from the lower end: a thousandth of the range at first.
double position(const Interval& range, int i) {
    const double x = static_cast<double>(i) / kSteps;
    return range.low + (range.high - range.low) * (dmath::exp2(10.0 * x) - 1.0) / 1023.0;
}

/// Values of the other argument that are looked at.
std::vector<double> other_values(const std::vector<Interval>& ranges, std::size_t own) {
    if (ranges.size() == 1) return {};
    const Interval& o = ranges[1 - own];
    std::vector<double> values;
    for (int i = 0; i < kOthers; ++i)
        values.push_back(o.low + (o.high - o.low) * i / (kOthers - 1));
    return values;
}

/// The bound beyond which the function rests.
double resting(TableFunction& f, const std::vector<Interval>& ranges, std::size_t own,
               double rest) {
    const Interval& range = ranges[own];
    std::vector<double> at;
    for (int k = 0; k <= kSteps; ++k) at.push_back(position(range, k));
    at.push_back(range.high);
    double peak = 0.0;
    std::vector<double> deviation(kSteps + 1, 0.0);
    f.rows(own, at, other_values(ranges, own), [&](std::size_t, std::span<const double> y) {
        const double end = y.back();
        for (std::size_t k = 0; k < deviation.size(); ++k) {
            deviation[k] = std::max(deviation[k], std::abs(y[k] - end));
            peak = std::max(peak, std::abs(y[k]));
        }
    });
    int last = kSteps;
    while (last > 0 && deviation[static_cast<std::size_t>(last - 1)] <= rest * peak) --last;
    return position(range, last);
}

bool same_below_zero(TableFunction& f, const std::vector<Interval>& ranges, std::size_t own) {
    std::vector<double> at{0.0};
    for (int k = 1; k <= 8; ++k) at.push_back(ranges[own].low * k / 8.0);
    bool same = true;
    f.rows(own, at, other_values(ranges, own), [&](std::size_t, std::span<const double> y) {
        for (const double value : y) same &= value == y.front();
    });
    return same;
}

/// How a function looks from texel to texel along one of its arguments.
struct Roughness {
    double error = 0.0;  ///< largest one halfway between texels
    double slope = 0.0, height = 0.0;
};

/// Looks near both ends and in between.
Roughness roughness(TableFunction& f, const std::vector<const Expr*>& args,
                    const std::vector<Interval>& ranges, std::size_t own, int size) {
    const Interval& range = ranges[own];
    const bool logarithmic = is_logarithmic(*args[own], range);
    const auto place = [&](double texel) {
        const double x = texel / (size - 1);
        if (!logarithmic) return range.low + (range.high - range.low) * x;
        return range.low * dmath::exp2(x * dmath::log2(range.high / range.low));
    };
    // A texel, the next one, and halfway to it.
    std::vector<double> at;
    for (int k = 0; k < 64; ++k) {
        // Neighbours 0, 1, 2, 3 .. from both ends, then further apart.
        const double from_end = k < 16 ? k / 2 : (k - 15) * (size - 2) / 100.0;
        const double texel = std::floor(k % 2 == 0 ? from_end : size - 2 - std::floor(from_end));
        for (const double step : {0.0, 1.0, 0.5}) at.push_back(place(texel + step));
    }
    Roughness seen;
    f.rows(own, at, other_values(ranges, own), [&](std::size_t, std::span<const double> values) {
        for (std::size_t k = 0; k < at.size(); k += 3) {
            const double a = values[k], b = values[k + 1];
            const double width = at[k + 1] - at[k];
            seen.error = std::max(seen.error, std::abs(values[k + 2] - 0.5 * (a + b)));
            seen.height = std::max({seen.height, std::abs(a), std::abs(b)});
            if (at[k + 1] > at[k]) seen.slope = std::max(seen.slope, std::abs(b - a) / width);
        }
    });
    return seen;
}

/// Of the best shape that the finest table can have.
void look_between_texels(TableFunction& f, const std::vector<const Expr*>& args,
                         TableDomain& domain) {
    domain.slopes.assign(args.size(), 0.0);
    const auto look = [&](std::size_t own, int size) {
        const Roughness seen = roughness(f, args, domain.arguments, own, size);
        domain.slopes[own] = std::max(domain.slopes[own], seen.slope);
        domain.height = std::max(domain.height, seen.height);
        return seen.error;
    };
    double error = std::numeric_limits<double>::infinity();
    if (args.size() == 1) {
        error = look(0, kFinest1d);
    } else {
        for (const int size : {kFinest1d, 512, kFinest2d / kFinest1d})
            error = std::min(error, std::max(look(0, size), look(1, kFinest2d / size)));
    }
    const double relative = error / std::max(domain.height, 1e-300);
    domain.error = std::isfinite(relative) ? relative : 1e3;
}

}  // namespace

bool is_logarithmic(const Expr& arg, const Interval& range) {
    if (arg.op != ExprOp::quantity || !(range.low > 0.0)) return false;
    switch (arg.coding) {
        case ExponentCoding::linear:
            return false;
        case ExponentCoding::logarithmic:
            return range.high > range.low;
        case ExponentCoding::automatic:
            break;
    }
    return range.high > 4.0 * range.low;
}

TableDomain table_domain(const Expr& function, const std::vector<const Expr*>& args, Ranges& ranges,
                         NumberModel numbers) {
    TableDomain domain;
    for (const Expr* arg : args) domain.arguments.push_back(ranges.of(*arg));
    TableFunction f(function, args);
    const double rest = numbers == NumberModel::wide ? 0x1p-12 : 0x1p-9;
    for (std::size_t i = 0; i < args.size(); ++i) {
        if (args[i]->op == ExprOp::quantity) continue;
        Interval& range = domain.arguments[i];
        if (range.low < 0.0 && range.high > 0.0 && same_below_zero(f, domain.arguments, i))
            range.low = 0.0;
        if (range.low >= 0.0) range.high = resting(f, domain.arguments, i, rest);
    }
    look_between_texels(f, args, domain);
    return domain;
}

}  // namespace burnish
