#include "models/terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <functional>
#include <map>

namespace burnish {

namespace {

/// Rebuilds a tree bottom-up. `leaf` may give another node for one, and ends the descent there.
class Rebuild {
  public:
    using Leaf = std::function<ExprPtr(const ExprPtr&)>;
    Rebuild(ExprBuilder& builder, Leaf leaf) : m_builder(builder), m_leaf(std::move(leaf)) {}

    ExprPtr operator()(const ExprPtr& e) {
        const auto at = m_made.find(e.get());
        if (at != m_made.end()) return at->second;
        ExprPtr made = m_leaf(e);
        if (!made) made = e->args.empty() ? e : again(e);
        m_made.emplace(e.get(), made);
        return made;
    }

  private:
    ExprPtr again(const ExprPtr& e) {
        std::vector<ExprPtr> args;
        for (const ExprPtr& arg : e->args) args.push_back((*this)(arg));
        m_builder.at(e->line, e->column);
        switch (e->op) {
            case ExprOp::add:
                return m_builder.add(args[0], args[1]);
            case ExprOp::multiply:
                return m_builder.product(args[0], args[1]);
            case ExprOp::divide:
                return m_builder.divide(args[0], args[1]);
            case ExprOp::dot:
                return m_builder.dot(args[0], args[1]);
            case ExprOp::power:
                return m_builder.power(args[0], args[1]);
            case ExprOp::square_root:
                return m_builder.square_root(args[0]);
            case ExprOp::exponential:
                return m_builder.exponential(args[0]);
            case ExprOp::minimum:
                return m_builder.minimum(args[0], args[1]);
            case ExprOp::maximum:
                return m_builder.maximum(args[0], args[1]);
            default:
                return e;
        }
    }

    ExprBuilder& m_builder;
    Leaf m_leaf;
    std::map<const Expr*, ExprPtr> m_made;  // looked up only
};

/// Factors of a term, in the order of the text.
struct Factors {
    glm::dvec3 factor{1.0};
    std::vector<ExprPtr> colors, scalars;
};

Factors joined(const Factors& a, const Factors& b) {
    Factors out = a;
    out.factor *= b.factor;
    out.colors.insert(out.colors.end(), b.colors.begin(), b.colors.end());
    out.scalars.insert(out.scalars.end(), b.scalars.begin(), b.scalars.end());
    return out;
}

[[noreturn]] void no_sum(const Expr& e) {
    throw Error(ErrorCode::bad_program,
                fmt::format("{}:{}: a colour in the pixel's functions, expected sums of colours "
                            "times numbers",
                            e.line, e.column));
}

std::vector<Factors> expanded(const ExprPtr& e) {
    Factors own;
    if (e->op == ExprOp::constant) {
        own.factor = e->value;
        return {own};
    }
    if (e->kind == ValueKind::color && e->op == ExprOp::quantity) {
        own.colors.push_back(e);
        return {own};
    }
    if (e->op == ExprOp::multiply) {
        std::vector<Factors> products;
        for (const Factors& a : expanded(e->args[0])) {
            for (const Factors& b : expanded(e->args[1])) products.push_back(joined(a, b));
        }
        if (products.size() == 1 || e->kind == ValueKind::color) return products;
    }
    if (e->kind == ValueKind::scalar) {
        own.scalars.push_back(e);
        return {own};
    }
    if (e->op != ExprOp::add) no_sum(*e);
    std::vector<Factors> sum = expanded(e->args[0]);
    for (const Factors& more : expanded(e->args[1])) sum.push_back(more);
    return sum;
}

}  // namespace

ExprPtr name_quantities(const ExprPtr& value, ExprBuilder& builder) {
    int unnamed = 0;
    std::map<const Expr*, ExprPtr> named;  // looked up only
    const std::function<ExprPtr(const ExprPtr&)> quantity = [&](const ExprPtr& e) -> ExprPtr {
        if (e->op == ExprOp::quantity) return e;
        if (e->op == ExprOp::parameter) return builder.quantity(e->name, e);
        // Constants stand outside, but for vectors, which dot products take as they are.
        if (e->op == ExprOp::multiply && e->args[0]->op == ExprOp::constant &&
            e->kind != ValueKind::vector)
            return builder.multiply(e->args[0], quantity(e->args[1]));
        const auto at = named.find(e.get());
        if (at != named.end()) return at->second;
        return named[e.get()] = builder.quantity(fmt::format("q{}", unnamed++), e);
    };
    return Rebuild(builder, [&](const ExprPtr& e) -> ExprPtr {
        return e->binding == Binding::texel ? quantity(e) : nullptr;
    })(value);
}

std::vector<const Expr*> quantities_of(const Expr& value) {
    std::vector<const Expr*> found;
    std::map<const Expr*, bool> seen;  // looked up only
    const std::function<void(const Expr&)> visit = [&](const Expr& e) {
        if (!seen.emplace(&e, true).second) return;
        if (e.op == ExprOp::quantity) return found.push_back(&e);
        for (const ExprPtr& arg : e.args) visit(*arg);
    };
    visit(value);
    std::sort(found.begin(), found.end(), ByAge{});
    return found;
}

ExprPtr with_constants(const ExprPtr& value, ExprBuilder& builder,
                       const std::vector<std::pair<const Expr*, glm::dvec3>>& constants) {
    return Rebuild(builder, [&](const ExprPtr& e) -> ExprPtr {
        if (e->op != ExprOp::quantity) return nullptr;
        for (const auto& [quantity, constant] : constants) {
            if (quantity == e.get()) return builder.constant(e->kind, constant);
        }
        return e;
    })(value);
}

std::vector<ModelTerm> terms_of(const ExprPtr& value, ExprBuilder& builder) {
    std::vector<ModelTerm> terms;
    for (const Factors& f : expanded(value)) {
        ModelTerm term;
        term.factor = f.factor;
        for (auto color = f.colors.rbegin(); color != f.colors.rend(); ++color)
            term.color = term.color ? builder.multiply(*color, term.color) : *color;
        // From the last one on: what (a + c f) x has in common is x.
        for (auto scalar = f.scalars.rbegin(); scalar != f.scalars.rend(); ++scalar)
            term.scalar = term.scalar ? builder.multiply(*scalar, term.scalar) : *scalar;
        if (term.factor != glm::dvec3(0.0)) terms.push_back(term);
    }
    return terms;
}

}  // namespace burnish
