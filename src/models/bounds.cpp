#include "models/bounds.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <cmath>

namespace burnish {

namespace {

bool is_bounded(const Expr& e, Ranges& ranges) {
    const Interval range = ranges.of(e);
    return std::isfinite(range.low) && std::isfinite(range.high);
}

/// What is wrong with an operation of bounded arguments.
std::string reason(const Expr& e, Ranges& ranges) {
    const auto may_be_zero = [](const Expr& x) {
        const std::string text = print_expression(x);
        return fmt::format("{} may be 0, expected a bound above it, as max(1/32, {})", text, text);
    };
    if (e.op == ExprOp::divide) return may_be_zero(*e.args[1]);
    if (e.op == ExprOp::power && ranges.of(*e.args[1]).low < 0.0) return may_be_zero(*e.args[0]);
    const Expr& x = *e.args[0];
    return fmt::format("{} reaches {:.6g}, expected less, as min(10, {})", print_expression(x),
                       ranges.of(x).high, print_expression(x));
}

}  // namespace

void require_bounds(const std::vector<const Expr*>& values, Ranges& ranges,
                    const std::string& material) {
    for (const Expr* value : values) {
        if (is_bounded(*value, ranges)) continue;
        const Expr* e = value;
        for (std::size_t i = 0; i < e->args.size();) {
            const Expr& arg = *e->args[i];
            const bool is_cause = arg.kind == ValueKind::scalar && !is_bounded(arg, ranges);
            if (is_cause) e = &arg;
            i = is_cause ? 0 : i + 1;
        }
        throw Error(ErrorCode::bad_program,
                    fmt::format("material '{}', model_text:{}:{}: {} is unbounded: {}", material,
                                e->line, e->column, print_expression(*e), reason(*e, ranges)));
    }
}

}  // namespace burnish
