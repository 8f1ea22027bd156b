#include "models/cover.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <limits>

#include "core/dmath.hpp"
#include "models/table_domain.hpp"

namespace burnish {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLog2E = 1.4426950408889634;
constexpr std::size_t kMostArguments = 2;

/// Of a node; the lowest are kept. Built-in models have up to 26, long texts would have thousands.
constexpr std::size_t kMostCuts = 64;

/// In halves of a stage's portion: what a model is charged for.
constexpr double kOperation = 1.0, kTable1d = 2.0, kTable2d = 3.5;

/// A pass for the coordinates, one for the texel, in the place of a few operations.
constexpr double kPasses = 6.0;

/// And for interpolation that is off by the table's whole height.
constexpr double kRoughness = 1000.0;

/// Of a wide register, over its largest number: what arithmetic rounds to.
constexpr double kCode = 0x1p-14;

bool is_leaf(const Expr& e) {
    return e.op == ExprOp::constant || e.op == ExprOp::geometry || e.op == ExprOp::quantity ||
           e.op == ExprOp::parameter || e.op == ExprOp::dot;
}

Interval product(const Interval& a, const Interval& b) {
    const double ends[] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    Interval out{kInfinity, -kInfinity};
    for (double end : ends) {
        if (std::isnan(end)) end = 0.0;  // 0 times infinity
        out.low = std::min(out.low, end);
        out.high = std::max(out.high, end);
    }
    return out;
}

}  // namespace

int squarings(double exponent) {
    for (int k = 0; k <= 10; ++k) {
        if (exponent == std::ldexp(1.0, k)) return k;
    }
    return -1;
}

Interval Ranges::of(const Expr& e) {
    const auto at = m_known.find(&e);
    if (at != m_known.end()) return at->second;
    const Interval range = computed(e);
    m_known.emplace(&e, range);
    return range;
}

Interval Ranges::computed(const Expr& e) {
    const auto arg = [&](std::size_t i) { return of(*e.args[i]); };
    switch (e.op) {
        case ExprOp::constant:
            return {std::min({e.value.x, e.value.y, e.value.z}),
                    std::max({e.value.x, e.value.y, e.value.z})};
        case ExprOp::geometry:
            return e.kind == ValueKind::vector ? Interval{1.0, 1.0} : Interval{0.0, 1.0};
        case ExprOp::add:
            return {arg(0).low + arg(1).low, arg(0).high + arg(1).high};
        case ExprOp::multiply: {
            if (e.args[0] != e.args[1]) return product(arg(0), arg(1));
            const Interval a = arg(0);
            const double high = std::max(a.low * a.low, a.high * a.high);
            return {a.low <= 0.0 && a.high >= 0.0 ? 0.0 : std::min(a.low * a.low, a.high * a.high),
                    high};
        }
        case ExprOp::divide: {
            const Interval b = arg(1);
            if (b.low <= 0.0 && b.high >= 0.0) return {-kInfinity, kInfinity};
            return product(arg(0), {1.0 / b.high, 1.0 / b.low});
        }
        case ExprOp::dot: {
            const double length = arg(0).high * arg(1).high;
            return {-length, length};
        }
        case ExprOp::power: {
            const Interval a = arg(0), b = arg(1);
            const double base = std::max(a.high, 0.0);
            if (b.low < 0.0) return {0.0, a.low > 0.0 ? dmath::pow(a.low, b.low) : kInfinity};
            return {0.0, base <= 1.0 ? std::max(dmath::pow(base, b.low), b.low == 0.0 ? 1.0 : 0.0)
                                     : dmath::pow(base, b.high)};
        }
        case ExprOp::square_root:
            return {std::sqrt(std::max(arg(0).low, 0.0)), std::sqrt(std::max(arg(0).high, 0.0))};
        case ExprOp::exponential:
            return {dmath::exp2(arg(0).low * kLog2E), dmath::exp2(arg(0).high * kLog2E)};
        case ExprOp::minimum:
            return {std::min(arg(0).low, arg(1).low), std::min(arg(0).high, arg(1).high)};
        case ExprOp::maximum:
            return {std::max(arg(0).low, arg(1).low), std::max(arg(0).high, arg(1).high)};
        default:
            return {-kInfinity, kInfinity};
    }
}

Cover::Cover(const std::vector<const Expr*>& roots, Ranges& ranges, NumberModel numbers,
             TablePrice tables)
    : m_ranges(ranges), m_numbers(numbers), m_price(tables) {
    for (const Expr* root : roots) choose(*root);
}

const TableCut* Cover::table(const Expr& e) const {
    const auto at = m_best.find(&e);
    return at != m_best.end() && at->second.is_table ? &at->second.cut : nullptr;
}

bool Cover::bounded(const Expr& e) {
    const Interval range = m_ranges.of(e);
    return std::isfinite(range.low) && std::isfinite(range.high);
}

const std::vector<NodeSet>& Cover::cuts(const Expr& e) {
    const auto at = m_cuts.find(&e);
    if (at != m_cuts.end()) return at->second;
    std::vector<NodeSet> found;
    if (e.op == ExprOp::constant) {
        found.push_back({});
    } else {
        // Multiples are read from what they are multiples of.
        const bool is_multiple = e.op == ExprOp::multiply && e.args[0]->op == ExprOp::constant;
        if (!is_multiple) found.push_back({&e});
        // A clamped value is for a register: tables are of what it is, not of what is below it.
        if (!is_leaf(e) && symmetric_clamp(e) == nullptr) {
            std::vector<NodeSet> merged{{}};
            for (const ExprPtr& arg : e.args) {
                std::vector<NodeSet> wider;
                for (const auto& have : merged) {
                    for (const auto& more : cuts(*arg)) {
                        NodeSet both = have;
                        both.insert(more.begin(), more.end());
                        const bool is_new =
                            std::find(wider.begin(), wider.end(), both) == wider.end();
                        if (both.size() <= kMostArguments && is_new) wider.push_back(both);
                    }
                }
                merged = std::move(wider);
            }
            const std::size_t kept = std::min(merged.size(), kMostCuts);
            found.insert(found.end(), merged.end() - static_cast<std::ptrdiff_t>(kept),
                         merged.end());
        }
    }
    return m_cuts.emplace(&e, std::move(found)).first->second;
}

double Cover::cost_of_fetch(const Expr& e, const NodeSet& cut) {
    if (m_price == TablePrice::none || cut.empty() || cut.contains(&e)) return kInfinity;
    double cost = cut.size() == 1 ? kTable1d : kTable2d;
    if (m_price == TablePrice::passes) cost += kPasses;
    bool of_pixel = false;
    for (const Expr* arg : cut) {
        if (arg->kind != ValueKind::scalar || !bounded(*arg)) return kInfinity;
        of_pixel |= arg->binding == Binding::pixel;
        cost += best(*arg).cost;
    }
    return of_pixel ? cost : kInfinity;
}

Cover::Way Cover::looked_up(const Expr& e, const NodeSet& cut, double cost) {
    Way way;
    way.is_table = true;
    way.cut.args.assign(cut.begin(), cut.end());
    const TableDomain domain = table_domain(e, way.cut.args, m_ranges, m_numbers);
    double error = domain.error;
    for (std::size_t i = 0; i < way.cut.args.size(); ++i) {
        const Expr& arg = *way.cut.args[i];
        double off = best(arg).error;
        if (m_numbers == NumberModel::wide && !is_leaf(arg)) {
            const Interval& range = domain.arguments[i];
            off += kCode * std::max(std::abs(range.low), std::abs(range.high));
        }
        if (off > 0.0) error += off * domain.slopes[i] / domain.height;
    }
    if (m_numbers == NumberModel::wide) error += kCode;
    way.height = domain.height;
    way.error = error * domain.height;
    way.cost = cost + kRoughness * error;
    if (std::isnan(way.cost)) way.cost = kInfinity;
    return way;
}

/// 1 - x of 0 <= x <= 1, which a mapping gives.
bool Cover::is_inverse(const Expr& e) {
    const Expr& x = *e.args[1];
    if (!is_number(*e.args[0], 1.0) || x.op != ExprOp::multiply || !is_number(*x.args[0], -1.0))
        return false;
    const Interval range = m_ranges.of(*x.args[1]);
    return range.low >= 0.0 && range.high <= 1.0;
}

const Cover::Way& Cover::best(const Expr& e) {
    const auto at = m_best.find(&e);
    if (at != m_best.end()) return at->second;
    Way way;
    const auto arg = [&](std::size_t i) { return best(*e.args[i]).cost; };
    const auto is_constant = [&](std::size_t i) { return e.args[i]->op == ExprOp::constant; };
    if (is_leaf(e)) {
        way.cost = e.op == ExprOp::dot ? kOperation : 0.0;
        return m_best.emplace(&e, way).first->second;
    }
    way.cost = kInfinity;
    switch (e.op) {
        case ExprOp::multiply:
            if (e.args[0] == e.args[1]) {
                way.cost = arg(0) + kOperation;
            } else {
                way.cost = arg(0) + arg(1) + (is_constant(0) || is_constant(1) ? 0.0 : kOperation);
            }
            break;
        case ExprOp::add: {
            if (is_inverse(e)) {
                way.cost = best(*e.args[1]->args[1]).cost;
                break;
            }
            way.cost = kOperation;
            for (const ExprPtr& a : e.args) {
                // A product of two pixel values comes along with its sum.
                const bool is_product =
                    a->op == ExprOp::multiply && a->args[0]->op != ExprOp::constant;
                way.cost += best(*a).cost - (is_product ? kOperation : 0.0);
            }
            break;
        }
        case ExprOp::maximum:
            if (is_number(*e.args[0], 0.0) || is_number(*e.args[1], 0.0))
                way.cost = arg(0) + arg(1);
            break;
        case ExprOp::minimum:
            if (const Expr* inner = symmetric_clamp(e)) {
                way.cost = best(*inner).cost + kOperation;
            } else if (is_constant(0) || is_constant(1)) {
                const Way& below = best(*e.args[is_constant(0) ? 1 : 0]);
                const double bound = e.args[is_constant(0) ? 0 : 1]->value.x;
                way.cost = arg(0) + arg(1) + kOperation;
                // What is a small error of a high function is a large one of what is left of it.
                if (below.is_table && bound > 0.0 && bound < below.height)
                    way.cost += kRoughness * below.error * (1.0 / bound - 1.0 / below.height);
            }
            break;
        case ExprOp::power:
            if (is_constant(1) && squarings(e.args[1]->value.x) > 0)
                way.cost = arg(0) + kOperation * squarings(e.args[1]->value.x);
            break;
        default:
            break;
    }
    const bool hard = way.cost == kInfinity;
    // From the lowest cut on, which of equal ones leaves most to the table; and what is too dear
    // without its errors is not looked at.
    const std::vector<NodeSet>& all = cuts(e);
    for (auto cut = all.rbegin(); cut != all.rend(); ++cut) {
        const double cost = cost_of_fetch(e, *cut);
        if (!(cost < way.cost)) continue;
        const Way table = looked_up(e, *cut, cost);
        if (table.cost < way.cost) way = table;
    }
    // What is computed is as good as what is looked up, or better: a tie is the combiners'.
    if (hard && way.cost == kInfinity && m_price != TablePrice::none) {
        throw Error(
            ErrorCode::bad_program,
            fmt::format("model_text:{}:{}: a table that has no bound: expected arguments that stay "
                        "finite, as with max(1/32, ...)",
                        e.line, e.column));
    }
    return m_best.emplace(&e, std::move(way)).first->second;
}

void Cover::choose(const Expr& e) {
    if (e.kind != ValueKind::scalar || e.op == ExprOp::constant || e.op == ExprOp::quantity) return;
    if (!m_chosen.insert(&e).second) return;
    const Way& way = best(e);
    if (way.is_table) {
        for (const Expr* arg : way.cut.args) choose(*arg);
        m_tables.push_back(&e);
    } else if (const Expr* inner = symmetric_clamp(e)) {
        choose(*inner);
    } else if (!is_leaf(e)) {
        for (const ExprPtr& arg : e.args) choose(*arg);
    }
}

}  // namespace burnish
