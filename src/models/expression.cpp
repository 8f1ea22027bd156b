#include "models/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <tuple>
#include <unordered_map>

#include "models/scalar_operations.hpp"

namespace burnish {

namespace {

struct Leaf {
    std::string_view name;
    ExprOp op;
    ValueKind kind;
};
constexpr std::array kLeaves{
    Leaf{"n", ExprOp::parameter, ValueKind::vector},
    Leaf{"t", ExprOp::parameter, ValueKind::vector},
    Leaf{"b", ExprOp::parameter, ValueKind::vector},
    Leaf{"alpha_x", ExprOp::parameter, ValueKind::scalar},
    Leaf{"alpha_y", ExprOp::parameter, ValueKind::scalar},
    Leaf{"N", ExprOp::parameter, ValueKind::scalar},
    Leaf{"ks", ExprOp::parameter, ValueKind::color},
    Leaf{"kd", ExprOp::parameter, ValueKind::color},
    Leaf{"l", ExprOp::geometry, ValueKind::vector},
    Leaf{"v", ExprOp::geometry, ValueKind::vector},
    Leaf{"h", ExprOp::geometry, ValueKind::vector},
    Leaf{"n_dot_l", ExprOp::geometry, ValueKind::scalar},
    Leaf{"h_dot_l", ExprOp::geometry, ValueKind::scalar},
};

/// x along u, y towards smaller rows, z along the mesh's normal.
struct Axis {
    std::string_view name;
    glm::dvec3 value;
};
constexpr std::array kAxes{Axis{"ex", {1.0, 0.0, 0.0}}, Axis{"ey", {0.0, 1.0, 0.0}},
                           Axis{"ez", {0.0, 0.0, 1.0}}};

Binding later(Binding a, Binding b) {
    return std::max(a, b);
}

ValueKind wider(ValueKind a, ValueKind b) {
    return a == ValueKind::scalar ? b : a;
}

bool is_texel_scalar(const Expr& e) {
    return e.kind == ValueKind::scalar && e.binding != Binding::pixel;
}

}  // namespace

struct ExprBuilder::Table {
    using Key = std::tuple<ExprOp, ValueKind, Binding, std::string, double, double, double,
                           std::vector<const Expr*>>;
    std::map<Key, ExprPtr> nodes;
};

ExprBuilder::ExprBuilder() : m_table(std::make_unique<Table>()) {}
ExprBuilder::~ExprBuilder() = default;

void ExprBuilder::at(std::size_t line, std::size_t column) {
    m_line = line;
    m_column = column;
}

ExprPtr ExprBuilder::intern(Expr expr) {
    std::vector<const Expr*> args;
    for (const ExprPtr& arg : expr.args) args.push_back(arg.get());
    Table::Key key{expr.op,      expr.kind,    expr.binding, expr.name,
                   expr.value.x, expr.value.y, expr.value.z, args};
    const auto at = m_table->nodes.find(key);
    if (at != m_table->nodes.end()) return at->second;
    expr.line = m_line;
    expr.column = m_column;
    expr.id = m_table->nodes.size();
    auto made = std::make_shared<const Expr>(std::move(expr));
    m_table->nodes.emplace(std::move(key), made);
    return made;
}

ExprPtr ExprBuilder::constant(ValueKind kind, const glm::dvec3& value) {
    return intern({.op = ExprOp::constant,
                   .kind = kind,
                   .binding = Binding::constant,
                   .value = value,
                   .name = {},
                   .args = {}});
}
ExprPtr ExprBuilder::number(double value) {
    return constant(ValueKind::scalar, glm::dvec3(value));
}

std::vector<std::string_view> ExprBuilder::leaf_names() {
    std::vector<std::string_view> names;
    for (const Leaf& leaf : kLeaves) names.push_back(leaf.name);
    return names;
}
std::vector<std::string_view> ExprBuilder::axis_names() {
    std::vector<std::string_view> names;
    for (const Axis& axis : kAxes) names.push_back(axis.name);
    return names;
}

ExprPtr ExprBuilder::leaf(std::string_view name) {
    for (const Axis& axis : kAxes) {
        if (axis.name == name) return constant(ValueKind::vector, axis.value);
    }
    const auto at = std::find_if(kLeaves.begin(), kLeaves.end(),
                                 [&](const Leaf& leaf) { return leaf.name == name; });
    if (at == kLeaves.end()) return nullptr;
    return intern({.op = at->op,
                   .kind = at->kind,
                   .binding = at->op == ExprOp::geometry ? Binding::pixel : Binding::texel,
                   .value = {},
                   .name = std::string(name),
                   .args = {}});
}

ExprPtr ExprBuilder::quantity(std::string name, const ExprPtr& value) {
    return quantity_of(std::move(name), value, Binding::texel, Extreme::none);
}

ExprPtr ExprBuilder::filtered(const ExprPtr& value) {
    const bool has_name = value->op == ExprOp::quantity || value->op == ExprOp::parameter;
    return quantity_of(has_name ? value->name : print_expression(*value),
                       value->op == ExprOp::quantity ? value->args.front() : value, Binding::pixel,
                       Extreme::none);
}

ExprPtr ExprBuilder::extreme(Extreme which, const ExprPtr& value) {
    const ExprPtr& defined = value->op == ExprOp::quantity ? value->args.front() : value;
    return quantity_of(fmt::format("{}({})", which == Extreme::least ? "least" : "most",
                                   print_expression(*defined)),
                       defined, Binding::pixel, which);
}

ExprPtr ExprBuilder::quantity_of(std::string name, const ExprPtr& value, Binding binding,
                                 Extreme extreme) {
    if (value->binding == Binding::constant) return value;
    const bool is_exponent = value->op == ExprOp::parameter && value->name == "N";
    ExponentCoding coding = is_exponent ? m_exponent_coding : ExponentCoding::automatic;
    // What the text itself calls filtered has no other mean.
    if (binding == Binding::pixel && coding == ExponentCoding::automatic)
        coding = ExponentCoding::linear;
    return intern({.op = ExprOp::quantity,
                   .kind = value->kind,
                   .binding = binding,
                   .value = {},
                   .name = std::move(name),
                   .args = {value},
                   .coding = coding,
                   .extreme = extreme});
}

ExprPtr ExprBuilder::node(ExprOp op, ValueKind kind, std::vector<ExprPtr> args) {
    Binding binding = Binding::constant;
    for (const ExprPtr& arg : args) binding = later(binding, arg->binding);
    Expr expr{.op = op, .kind = kind, .binding = binding, .value = {}, .name = {}, .args = args};
    if (binding == Binding::constant) {
        glm::dvec3 value;
        Tape({&expr}, {}).run(nullptr, &value);
        return constant(kind, value);
    }
    return intern(std::move(expr));
}

ExprPtr ExprBuilder::add(const ExprPtr& a, const ExprPtr& b) {
    if (is_number(*a, 0.0)) return b;
    if (is_number(*b, 0.0)) return a;
    // c - x - y = c + -1 (x + y): constants meet, and what is subtracted is one sum.
    if (b->binding == Binding::constant && a->binding != Binding::constant) return add(b, a);
    if (is_negation(*a) && is_negation(*b)) return negate(add(a->args[1], b->args[1]));
    if (a->op == ExprOp::add && a->args[0]->op == ExprOp::constant) {
        if (b->op == ExprOp::constant) return add(add(a->args[0], b), a->args[1]);
        return add(a->args[0], add(a->args[1], b));
    }
    if (a->op != ExprOp::constant && b->op == ExprOp::add && b->args[0]->op == ExprOp::constant)
        return add(b->args[0], add(a, b->args[1]));
    return node(ExprOp::add, wider(a->kind, b->kind), {a, b});
}

ExprPtr ExprBuilder::multiply(const ExprPtr& a, const ExprPtr& b) {
    // (g . Q) s = g . (Q s) for what is known at the texel: one quantity instead of a product. What
    // has a name is filtered as it is.
    const auto into_dot = [&](const ExprPtr& d, const ExprPtr& s) -> ExprPtr {
        if (d->op != ExprOp::dot || !is_texel_scalar(*s) || s->op == ExprOp::quantity ||
            is_number(*s, 0.0) || is_number(*s, 1.0))
            return nullptr;
        for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
            if (d->args[i]->binding == Binding::pixel || d->args[1 - i]->op != ExprOp::geometry)
                continue;
            return dot(d->args[1 - i], multiply(d->args[i], s));
        }
        return nullptr;
    };
    if (ExprPtr inside = into_dot(a, b)) return inside;
    if (ExprPtr inside = into_dot(b, a)) return inside;
    return product(a, b);
}

ExprPtr ExprBuilder::product(const ExprPtr& a, const ExprPtr& b) {
    if (is_number(*a, 1.0)) return b;
    if (is_number(*b, 1.0)) return a;
    if (a->kind == ValueKind::scalar && b->kind == ValueKind::scalar &&
        (is_number(*a, 0.0) || is_number(*b, 0.0)))
        return number(0.0);
    // Constants first, so that they meet.
    if (b->binding == Binding::constant && a->binding != Binding::constant) return product(b, a);
    if (a->binding == Binding::constant && a->kind == ValueKind::scalar &&
        b->op == ExprOp::multiply && b->args[0]->binding == Binding::constant)
        return product(product(a, b->args[0]), b->args[1]);
    return node(ExprOp::multiply, wider(a->kind, b->kind), {a, b});
}

ExprPtr ExprBuilder::divide(const ExprPtr& a, const ExprPtr& b) {
    if (b->binding == Binding::constant) return multiply(number(1.0 / b->value.x), a);
    // What is known at the texel becomes a factor.
    if (b->binding != Binding::pixel && a->binding == Binding::pixel)
        return multiply(a, node(ExprOp::divide, ValueKind::scalar, {number(1.0), b}));
    if (a->kind != ValueKind::scalar && b->binding == Binding::pixel)
        return multiply(a, divide(number(1.0), b));
    return node(ExprOp::divide, a->kind, {a, b});
}

ExprPtr ExprBuilder::negate(const ExprPtr& a) {
    return multiply(number(-1.0), a);
}

ExprPtr ExprBuilder::dot(const ExprPtr& a, const ExprPtr& b) {
    if (a->op == ExprOp::geometry && b->op == ExprOp::geometry) {
        // h bisects l and v.
        if (a->name == b->name) return number(1.0);
        const ExprPtr hl = leaf("h_dot_l");
        if (a->name == "h" || b->name == "h") return hl;
        return add(multiply(number(2.0), multiply(hl, hl)), number(-1.0));
    }
    for (const ExprPtr& e : {a, b}) {
        if (e->op == ExprOp::constant && e->value == glm::dvec3(0.0)) return number(0.0);
    }
    const bool swapped = b->op == ExprOp::geometry;
    return node(ExprOp::dot, ValueKind::scalar, {swapped ? b : a, swapped ? a : b});
}

ExprPtr ExprBuilder::power(const ExprPtr& base, const ExprPtr& exponent) {
    if (is_number(*exponent, 1.0)) return base;
    if (is_number(*exponent, 2.0)) return multiply(base, base);
    if (is_number(*exponent, 4.0)) {
        const ExprPtr square = multiply(base, base);
        return multiply(square, square);
    }
    return node(ExprOp::power, ValueKind::scalar, {base, exponent});
}

ExprPtr ExprBuilder::square_root(const ExprPtr& a) {
    return node(ExprOp::square_root, ValueKind::scalar, {a});
}
ExprPtr ExprBuilder::exponential(const ExprPtr& a) {
    return node(ExprOp::exponential, ValueKind::scalar, {a});
}
ExprPtr ExprBuilder::minimum(const ExprPtr& a, const ExprPtr& b) {
    return node(ExprOp::minimum, wider(a->kind, b->kind), {a, b});
}
ExprPtr ExprBuilder::maximum(const ExprPtr& a, const ExprPtr& b) {
    return node(ExprOp::maximum, wider(a->kind, b->kind), {a, b});
}

namespace {

glm::dvec3 computed(ExprOp op, const glm::dvec3& a, const glm::dvec3& b) {
    switch (op) {
        case ExprOp::add:
            return a + b;
        case ExprOp::multiply:
            return a * b;
        case ExprOp::divide:
            return a / b;
        case ExprOp::dot:
            return glm::dvec3((a.x * b.x + a.y * b.y) + a.z * b.z);
        case ExprOp::power:
            return glm::dvec3(power_of(a.x, b.x));
        case ExprOp::square_root:
            return glm::dvec3(root_of(a.x));
        case ExprOp::exponential:
            return glm::dvec3(exponential_of(a.x));
        case ExprOp::minimum:
            return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
        case ExprOp::maximum:
            return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
        default:
            return a;
    }
}

}  // namespace

Tape::Tape(const std::vector<const Expr*>& roots, const std::vector<const Expr*>& inputs)
    : m_inputs(inputs.size()), m_values(inputs.size()) {
    std::unordered_map<const Expr*, std::size_t> slots;
    for (std::size_t i = 0; i < inputs.size(); ++i) slots.emplace(inputs[i], i);
    const auto visit = [&](const auto& self, const Expr& e) -> std::size_t {
        const auto at = slots.find(&e);
        if (at != slots.end()) return at->second;
        Step step{e.op, {0, 0}};
        for (std::size_t i = 0; i < e.args.size(); ++i) step.args[i] = self(self, *e.args[i]);
        const std::size_t slot = m_values.size();
        const bool unknown = e.op == ExprOp::parameter || e.op == ExprOp::geometry;
        m_values.push_back(unknown ? glm::dvec3(std::numeric_limits<double>::quiet_NaN())
                                   : e.value);
        if (e.args.empty()) step = {ExprOp::constant, {slot, slot}};
        m_steps.push_back(step);
        slots.emplace(&e, slot);
        return slot;
    };
    for (const Expr* root : roots) m_roots.push_back(visit(visit, *root));
}

void Tape::run(const glm::dvec3* inputs, glm::dvec3* roots) {
    std::copy_n(inputs, m_inputs, m_values.begin());
    glm::dvec3* to = m_values.data() + m_inputs;
    for (const Step& step : m_steps) {
        *to++ = computed(step.op, m_values[step.args[0]], m_values[step.args[1]]);
    }
    for (const std::size_t root : m_roots) *roots++ = m_values[root];
}

namespace {

/// Writes expressions. What is shared is written again, so that short texts may print long.
class Printer {
  public:
    void print(const Expr& e) {
        constexpr std::size_t kLongest = 2000;
        if (m_text.size() > kLongest) {
            m_text += "...";
            return;
        }
        switch (e.op) {
            case ExprOp::constant:
                for (const Axis& axis : kAxes) {
                    if (e.kind != ValueKind::vector || e.value != axis.value) continue;
                    m_text += axis.name;
                    return;
                }
                m_text +=
                    e.kind == ValueKind::scalar
                        ? fmt::format("{:.6g}", e.value.x)
                        : fmt::format("({:.6g}, {:.6g}, {:.6g})", e.value.x, e.value.y, e.value.z);
                return;
            case ExprOp::add:
                if (is_negation(*e.args[1])) return binary(*e.args[0], " - ", *e.args[1]->args[1]);
                return binary(*e.args[0], " + ", *e.args[1]);
            case ExprOp::multiply:
                if (is_negation(e)) {
                    m_text += '-';
                    return print(*e.args[1]);
                }
                if (e.args[0] != e.args[1]) return binary(*e.args[0], " * ", *e.args[1]);
                print_base(*e.args[0]);
                m_text += "^2";
                return;
            case ExprOp::divide:
                return binary(*e.args[0], " / ", *e.args[1]);
            case ExprOp::power:
                m_text += '(';
                print_base(*e.args[0]);
                m_text += '^';
                print(*e.args[1]);
                m_text += ')';
                return;
            case ExprOp::dot:
                return call("dot", e);
            case ExprOp::square_root:
                return call("sqrt", e);
            case ExprOp::exponential:
                return call("exp", e);
            case ExprOp::minimum:
                return call("min", e);
            case ExprOp::maximum:
                return call("max", e);
            default:
                // The names of extremes are calls themselves.
                if (e.op == ExprOp::quantity && e.binding == Binding::pixel &&
                    e.extreme == Extreme::none) {
                    m_text += "filtered(" + e.name + ")";
                } else {
                    m_text += e.name;
                }
        }
    }
    [[nodiscard]] std::string text() && { return std::move(m_text); }

  private:
    /// Signs and squares bind less than a power that is taken of them.
    void print_base(const Expr& e) {
        const bool is_square = e.op == ExprOp::multiply && e.args[0] == e.args[1];
        const bool is_negative = e.op == ExprOp::constant && e.value.x < 0.0;
        const bool in_braces = is_negation(e) || is_square || is_negative;
        if (in_braces) m_text += '(';
        print(e);
        if (in_braces) m_text += ')';
    }
    void binary(const Expr& a, std::string_view op, const Expr& b) {
        m_text += '(';
        print(a);
        m_text += op;
        print(b);
        m_text += ')';
    }
    void call(std::string_view name, const Expr& e) {
        m_text += name;
        for (std::size_t i = 0; i < e.args.size(); ++i) {
            m_text += i == 0 ? "(" : ", ";
            print(*e.args[i]);
        }
        m_text += ')';
    }

    std::string m_text;
};

}  // namespace

std::string print_expression(const Expr& expr) {
    Printer printer;
    printer.print(expr);
    return std::move(printer).text();
}

const Expr* symmetric_clamp(const Expr& e) {
    if (e.op != ExprOp::minimum || e.args[1]->op != ExprOp::constant) return nullptr;
    const Expr& inner = *e.args[0];
    const double bound = e.args[1]->value.x;
    if (inner.op != ExprOp::maximum || !(bound > 0.0)) return nullptr;
    return is_number(*inner.args[1], -bound) ? inner.args[0].get() : nullptr;
}

bool is_number(const Expr& expr, double value) {
    return expr.op == ExprOp::constant && expr.kind == ValueKind::scalar && expr.value.x == value;
}

bool is_negation(const Expr& e) {
    return e.op == ExprOp::multiply && is_number(*e.args[0], -1.0);
}

bool is_one_minus(const Expr& e) {
    return e.op == ExprOp::add && is_number(*e.args[0], 1.0) && is_negation(*e.args[1]);
}

}  // namespace burnish
