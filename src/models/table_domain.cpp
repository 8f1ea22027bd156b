#include "models/table_domain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dmath.hpp"

namespace burnish {

namespace {

constexpr int kSteps = 160, kOthers = 9;

/// Steps that grow with the distance from the lower end: a thousandth of the range at first.
double position(const Interval& range, int i) {
    const double x = static_cast<double>(i) / kSteps;
    return range.low + (range.high - range.low) * (dmath::exp2(10.0 * x) - 1.0) / 1023.0;
}

/// A function of one or two numbers.
class Function {
  public:
    Function(const Expr& e, const std::vector<const Expr*>& args)
        : m_tape({&e}, args), m_count(args.size()) {}
    double operator()(std::size_t own, double x, double other) {
        glm::dvec3 at[2]{glm::dvec3(other), glm::dvec3(other)}, result;
        at[own] = glm::dvec3(x);
        m_tape.run(at, &result);
        return result.x;
    }
    [[nodiscard]] int others() const { return m_count == 2 ? kOthers : 1; }

  private:
    Tape m_tape;
    std::size_t m_count;
};

/// Number `i` of the values of the other argument that are looked at.
double other_value(const std::vector<Interval>& ranges, std::size_t own, int i) {
    if (ranges.size() == 1) return 0.0;
    const Interval& o = ranges[1 - own];
    return o.low + (o.high - o.low) * i / (kOthers - 1);
}

/// The bound beyond which the function rests.
double resting(Function& f, const std::vector<Interval>& ranges, std::size_t own, double rest) {
    const Interval& range = ranges[own];
    double peak = 0.0;
    std::vector<double> deviation(kSteps + 1, 0.0);
    for (int i = 0; i < f.others(); ++i) {
        const double other = other_value(ranges, own, i);
        const double end = f(own, range.high, other);
        for (int k = 0; k <= kSteps; ++k) {
            const double y = f(own, position(range, k), other);
            deviation[static_cast<std::size_t>(k)] =
                std::max(deviation[static_cast<std::size_t>(k)], std::abs(y - end));
            peak = std::max(peak, std::abs(y));
        }
    }
    int last = kSteps;
    while (last > 0 && deviation[static_cast<std::size_t>(last - 1)] <= rest * peak) --last;
    return position(range, last);
}

bool same_below_zero(Function& f, const std::vector<Interval>& ranges, std::size_t own) {
    for (int i = 0; i < f.others(); ++i) {
        const double other = other_value(ranges, own, i);
        const double zero = f(own, 0.0, other);
        for (int k = 1; k <= 8; ++k) {
            if (f(own, ranges[own].low * k / 8.0, other) != zero) return false;
        }
    }
    return true;
}

/// How a function looks from texel to texel along one of its arguments.
struct Roughness {
    double error = 0.0;  ///< largest one halfway between texels
    double slope = 0.0, height = 0.0;
};

/// Looks near both ends and in between.
Roughness roughness(Function& f, const std::vector<const Expr*>& args,
                    const std::vector<Interval>& ranges, std::size_t own, int size) {
    const Interval& range = ranges[own];
    const bool logarithmic = is_logarithmic(*args[own], range);
    const auto at = [&](double texel) {
        const double x = texel / (size - 1);
        if (!logarithmic) return range.low + (range.high - range.low) * x;
        return range.low * dmath::exp2(x * dmath::log2(range.high / range.low));
    };
    Roughness seen;
    for (int i = 0; i < f.others(); ++i) {
        const double other = other_value(ranges, own, i);
        for (int k = 0; k < 64; ++k) {
            // Neighbours 0, 1, 2, 3 .. from both ends, then further apart.
            const double from_end = k < 16 ? k / 2 : (k - 15) * (size - 2) / 100.0;
            const double texel =
                std::floor(k % 2 == 0 ? from_end : size - 2 - std::floor(from_end));
            const double x = at(texel), y = at(texel + 1.0);
            const double a = f(own, x, other), b = f(own, y, other);
            seen.error =
                std::max(seen.error, std::abs(f(own, at(texel + 0.5), other) - 0.5 * (a + b)));
            seen.height = std::max({seen.height, std::abs(a), std::abs(b)});
            if (y > x) seen.slope = std::max(seen.slope, std::abs(b - a) / (y - x));
        }
    }
    return seen;
}

/// Of the best shape that the finest table can have.
void look_between_texels(Function& f, const std::vector<const Expr*>& args, TableDomain& domain) {
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
    return arg.op == ExprOp::quantity && range.low > 0.0 && range.high > 4.0 * range.low;
}

TableDomain table_domain(const Expr& function, const std::vector<const Expr*>& args, Ranges& ranges,
                         NumberModel numbers) {
    TableDomain domain;
    for (const Expr* arg : args) domain.arguments.push_back(ranges.of(*arg));
    Function f(function, args);
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
