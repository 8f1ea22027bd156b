#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "models/expression.hpp"

namespace burnish {

/// A number as a function of one or two others, in many places at once: the same bits as Tape has.
/// What depends on one argument alone is worked out once for each of its values.
class TableFunction {
  public:
    /// @param e     a scalar that is made of scalars down to its arguments
    /// @param args  one or two of the nodes below it; other leaves than constants are NaN
    TableFunction(const Expr& e, const std::vector<const Expr*>& args);

    /// Row by row: the values for argument `own` at each of `at`, the other argument at one of
    /// `others`. A function of one argument has one row, whatever `others` says.
    using Row = std::function<void(std::size_t other, std::span<const double> values)>;
    void rows(std::size_t own, std::span<const double> at, std::span<const double> others,
              const Row& row);

  private:
    /// Which arguments a node depends on, a bit for each.
    using Dependence = unsigned;
    struct Node {
        ExprOp op;
        std::array<std::size_t, 2> args;
        Dependence on;
    };
    /// Works out all nodes that depend on exactly `on`, of `count` values of it, into m_values.
    void work_out(Dependence on, std::size_t count);

    std::size_t m_arguments;
    std::vector<Node> m_nodes;                  ///< arguments first, what is needed before its use
    std::vector<std::vector<double>> m_values;  ///< of each node; of constants: a block of copies
    /// Copies of a value of the other argument, or a block of values of what depends on both.
    std::vector<std::vector<double>> m_blocks;
    std::vector<double> m_row;
    std::size_t m_root;
};

}  // namespace burnish
