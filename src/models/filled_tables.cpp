#include "models/filled_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "models/table_domain.hpp"
#include "models/table_function.hpp"

namespace burnish {

namespace {

/// Interpolation as good as texels are, of a table's height.
constexpr double kFine = 0x1p-15;
/// Values of the other argument at which a table is looked at.
constexpr int kOthers = 33;

class Filler {
  public:
    Filler(PlanTable& table, const Expr& function, const std::vector<const Expr*>& args,
           const std::vector<Interval>& domain)
        : m_table(table), m_expr(function), m_domain(domain), m_function(function, args) {}

    void fill(NumberModel numbers) {
        std::vector<PlanAxis>& axes = m_table.axes;
        for (PlanAxis& a : axes) a.size = 256;
        if (numbers != NumberModel::wide) {
            for (std::size_t own = 0; own < axes.size(); ++own)
                m_table.interpolation = std::max(m_table.interpolation, error_along(own, 256));
        } else if (!is_2d()) {
            for (int size = 256; size <= kFinest1d; size *= 2) {
                axes[0].size = size;
                m_table.interpolation = error_along(0, size);
                if (m_table.interpolation <= kFine * m_peak) break;
            }
        } else {
            choose_sizes();
        }
        write_texels();
    }

  private:
    [[nodiscard]] bool is_2d() const { return m_table.axes.size() == 2; }

    /// An argument as the function is asked for it.
    [[nodiscard]] double within(std::size_t own, double x) const {
        return std::clamp(x, m_domain[own].low, m_domain[own].high);
    }
    /// Of all texels of an axis.
    [[nodiscard]] std::vector<double> arguments(std::size_t own, const PlanAxis& axis) const {
        std::vector<double> at;
        for (int i = 0; i < axis.size; ++i) at.push_back(within(own, axis.argument(i)));
        return at;
    }

    /// The function's values, row by row. Of those without a bound the first is complained of.
    void rows(std::size_t own, std::span<const double> at, std::span<const double> others,
              const TableFunction::Row& row) {
        m_function.rows(own, at, others, [&](std::size_t j, std::span<const double> values) {
            bool bounded = true;
            for (const double v : values) bounded &= std::abs(v) < 1e6;
            if (!bounded) {
                const auto first = std::find_if(values.begin(), values.end(),
                                                [](double v) { return !(std::abs(v) < 1e6); });
                std::array<double, 2> place{};
                place[own] = at[static_cast<std::size_t>(first - values.begin())];
                if (is_2d()) place[1 - own] = others[j];
                fail_unbounded(*first, place);
            }
            row(j, values);
        });
    }
    [[noreturn]] void fail_unbounded(double value, const std::array<double, 2>& at) const {
        throw Error(ErrorCode::bad_program,
                    fmt::format("model_text:{}:{}: a table that has no bound: {} is {} at {}{}, "
                                "expected less than 10^6, as with max(1/32, ...)",
                                m_expr.line, m_expr.column, print_expression(m_expr), value, at[0],
                                is_2d() ? fmt::format(", {}", at[1]) : ""));
    }

    /// The largest error halfway between texels, of an axis of `size` texels, at some values of the
    /// other; of the texels that are seen the highest counts for the peak.
    double error_along(std::size_t own, int size) {
        PlanAxis a = m_table.axes[own];
        a.size = size;
        // The first texel; then the next one, and halfway to it.
        std::vector<double> at{within(own, a.argument(0))};
        for (int j = 0; j + 1 < size; ++j) {
            at.push_back(within(own, a.argument(j + 1)));
            at.push_back(within(own, a.between(j)));
        }
        double error = 0.0;
        rows(own, at, others_of(own), [&](std::size_t, std::span<const double> values) {
            double left = values[0];
            for (std::size_t j = 1; j < values.size(); j += 2) {
                const double right = values[j];
                m_peak = std::max({m_peak, std::abs(left), std::abs(right)});
                error = std::max(error, std::abs(values[j + 1] - 0.5 * (left + right)));
                left = right;
            }
        });
        return error;
    }

    /// The same for the peak alone.
    void look_along(std::size_t own, int size) {
        PlanAxis a = m_table.axes[own];
        a.size = size;
        rows(own, arguments(own, a), others_of(own),
             [&](std::size_t, std::span<const double> values) {
                 for (const double v : values) m_peak = std::max(m_peak, std::abs(v));
             });
    }

    /// Of the other argument: values at which a table is looked at.
    [[nodiscard]] std::vector<double> others_of(std::size_t own) const {
        if (!is_2d()) return {};
        PlanAxis other = m_table.axes[1 - own];
        other.size = kOthers;
        return arguments(1 - own, other);
    }

    /// Of the shapes that are fine enough the smallest; if none is, the best.
    void choose_sizes() {
        // Beyond an axis's first size that is fine no shape is better.
        std::array<std::map<int, double>, 2> errors;
        std::array<bool, 2> fine{};
        for (int size = kFinest2d / kFinest1d; size <= kFinest1d; size *= 2) {
            for (const std::size_t own : {std::size_t{0}, std::size_t{1}}) {
                if (fine[own]) {
                    look_along(own, size);
                    continue;
                }
                errors[own][size] = error_along(own, size);
                fine[own] = errors[own][size] <= kFine * m_peak;
            }
        }
        const auto score = [&](int x, int y) {
            const double error = std::max(errors[0][x], errors[1][y]);
            return std::pair(std::max(error, kFine * m_peak), x * y);
        };
        std::pair<int, int> best{64, 64};
        for (const auto& [x, unused_x] : errors[0]) {
            for (const auto& [y, unused_y] : errors[1]) {
                if (x * y <= kFinest2d && score(x, y) < score(best.first, best.second))
                    best = {x, y};
            }
        }
        m_table.axes[0].size = best.first;
        m_table.axes[1].size = best.second;
        m_table.interpolation = std::max(errors[0][best.first], errors[1][best.second]);
    }

    void write_texels() {
        PlanTable& t = m_table;
        t.unit = m_peak;
        std::vector<double> others;
        if (is_2d()) others = arguments(1, t.axes[1]);
        t.values.reserve(static_cast<std::size_t>(t.axes[0].size) *
                         std::max(others.size(), std::size_t{1}));
        rows(0, arguments(0, t.axes[0]), others, [&](std::size_t, std::span<const double> values) {
            for (const double f : values) {
                t.values.push_back(f / t.unit);
                t.coded |= f < 0.0;
            }
        });
        double highest = 0.0;
        for (const double v : t.values) highest = std::max(highest, std::abs(v));
        for (double& v : t.values) v /= highest;
        t.unit *= highest;
    }

    PlanTable& m_table;
    const Expr& m_expr;
    const std::vector<Interval>& m_domain;
    TableFunction m_function;
    double m_peak = 1e-9;
};

/// Whether coordinates mean the same arguments.
bool same_axis(const PlanAxis& a, const PlanAxis& b) {
    return a.input.mapping == b.input.mapping && a.unit == b.unit && a.is_signed == b.is_signed &&
           a.logarithmic == b.logarithmic && a.low == b.low;
}

/// What filling gives a table.
void copy_texels(const PlanTable& from, PlanTable& to) {
    for (std::size_t i = 0; i < to.axes.size(); ++i) to.axes[i].size = from.axes[i].size;
    to.values = from.values;
    to.unit = from.unit;
    to.coded = from.coded;
    to.interpolation = from.interpolation;
}

}  // namespace

void FilledTables::fill(PlanTable& table, const Expr& function,
                        const std::vector<const Expr*>& args, const std::vector<Interval>& domain,
                        NumberModel numbers) {
    const auto at = m_last.find(&function);
    if (at != m_last.end()) {
        const Entry& last = at->second;
        const bool same =
            last.args == args && last.domain == domain && last.numbers == numbers &&
            std::equal(table.axes.begin(), table.axes.end(), last.table.axes.begin(), same_axis);
        if (same) return copy_texels(last.table, table);
        m_kept -= last.table.values.size();
        m_last.erase(at);
    }
    Filler(table, function, args, domain).fill(numbers);
    if (m_kept + table.values.size() > kMostKept) return;
    m_kept += table.values.size();
    m_last.emplace(&function, Entry{args, domain, numbers, table});
}

}  // namespace burnish
