#include "models/table_function.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "models/scalar_operations.hpp"

namespace burnish {

namespace {

/// Values that fit the first-level cache with all that a step reads.
constexpr std::size_t kBlock = 128;

template <class Operation>
void each(const double* a, const double* b, double* out, std::size_t count, Operation operation) {
    for (std::size_t i = 0; i < count; ++i) out[i] = operation(a[i], b[i]);
}

void compute(ExprOp op, const double* a, const double* b, double* out, std::size_t count) {
    switch (op) {
        case ExprOp::add:
            return each(a, b, out, count, [](double x, double y) { return x + y; });
        case ExprOp::multiply:
            return each(a, b, out, count, [](double x, double y) { return x * y; });
        case ExprOp::divide:
            return each(a, b, out, count, [](double x, double y) { return x / y; });
        case ExprOp::power:
            return each(a, b, out, count, [](double x, double y) { return power_of(x, y); });
        case ExprOp::square_root:
            return each(a, b, out, count, [](double x, double) { return root_of(x); });
        case ExprOp::exponential:
            return each(a, b, out, count, [](double x, double) { return exponential_of(x); });
        case ExprOp::minimum:
            return each(a, b, out, count, [](double x, double y) { return std::min(x, y); });
        case ExprOp::maximum:
            return each(a, b, out, count, [](double x, double y) { return std::max(x, y); });
        default:
            std::copy_n(a, count, out);
    }
}

}  // namespace

TableFunction::TableFunction(const Expr& e, const std::vector<const Expr*>& args)
    : m_arguments(args.size()) {
    std::unordered_map<const Expr*, std::size_t> places;
    for (std::size_t i = 0; i < args.size(); ++i) {
        places.emplace(args[i], i);
        m_nodes.push_back({args[i]->op, {i, i}, 1U << i});
    }
    m_values.resize(args.size());
    const auto visit = [&](const auto& self, const Expr& node) -> std::size_t {
        const auto at = places.find(&node);
        if (at != places.end()) return at->second;
        Node made{node.op, {0, 0}, 0};
        for (std::size_t i = 0; i < node.args.size(); ++i) {
            made.args[i] = self(self, *node.args[i]);
            made.on |= m_nodes[made.args[i]].on;
        }
        if (node.args.size() == 1) made.args[1] = made.args[0];
        const std::size_t place = m_nodes.size();
        m_nodes.push_back(made);
        std::vector<double>& values = m_values.emplace_back();
        if (node.args.empty()) {
            values.assign(kBlock, node.op == ExprOp::constant
                                      ? node.value.x
                                      : std::numeric_limits<double>::quiet_NaN());
        } else if (made.on == 0) {
            values.resize(kBlock);
            compute(node.op, m_values[made.args[0]].data(), m_values[made.args[1]].data(),
                    values.data(), kBlock);
        }
        places.emplace(&node, place);
        return place;
    };
    m_root = visit(visit, e);
    m_blocks.assign(m_nodes.size(), std::vector<double>(kBlock));
}

void TableFunction::work_out(Dependence on, std::size_t count) {
    for (std::size_t place = m_arguments; place < m_nodes.size(); ++place) {
        const Node& node = m_nodes[place];
        if (node.on != on) continue;
        m_values[place].resize(count);
        for (std::size_t from = 0; from < count; from += kBlock) {
            const auto operand = [&](std::size_t i) {
                const double* values = m_values[node.args[i]].data();
                return m_nodes[node.args[i]].on == 0 ? values : values + from;
            };
            compute(node.op, operand(0), operand(1), m_values[place].data() + from,
                    std::min(kBlock, count - from));
        }
    }
}

void TableFunction::rows(std::size_t own, std::span<const double> at,
                         std::span<const double> others, const Row& row) {
    const Dependence on_own = 1U << own, on_other = 3U - on_own;
    m_values[own].assign(at.begin(), at.end());
    work_out(on_own, at.size());
    if (m_arguments == 2) {
        m_values[1 - own].assign(others.begin(), others.end());
        work_out(on_other, others.size());
    }
    m_row.resize(at.size());
    for (std::size_t j = 0; j < (m_arguments == 2 ? others.size() : 1); ++j) {
        const Dependence on_root = m_nodes[m_root].on;
        if (on_root == on_own) {
            row(j, m_values[m_root]);
            continue;
        }
        if (on_root != 3) {
            const std::vector<double>& values = m_values[m_root];
            std::fill(m_row.begin(), m_row.end(), on_root == 0 ? values[0] : values[j]);
            row(j, m_row);
            continue;
        }
        for (std::size_t place = 0; place < m_nodes.size(); ++place) {
            if (m_nodes[place].on == on_other)
                std::fill(m_blocks[place].begin(), m_blocks[place].end(), m_values[place][j]);
        }
        for (std::size_t from = 0; from < at.size(); from += kBlock) {
            const std::size_t count = std::min(kBlock, at.size() - from);
            const auto operand = [&](std::size_t place) {
                const Dependence on = m_nodes[place].on;
                if (on == 0) return m_values[place].data();
                return on == on_own ? m_values[place].data() + from : m_blocks[place].data();
            };
            for (std::size_t place = m_arguments; place < m_nodes.size(); ++place) {
                const Node& node = m_nodes[place];
                if (node.on != 3) continue;
                double* out = place == m_root ? m_row.data() + from : m_blocks[place].data();
                compute(node.op, operand(node.args[0]), operand(node.args[1]), out, count);
            }
        }
        row(j, m_row);
    }
}

}  // namespace burnish
