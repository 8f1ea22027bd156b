#pragma once

#include <burnish/machine.hpp>
#include <map>
#include <set>
#include <vector>

#include "models/expression.hpp"

namespace burnish {

using NodeSet = std::set<const Expr*, ByAge>;

struct Interval {
    double low = 0.0, high = 0.0;

    friend bool operator==(const Interval&, const Interval&) = default;
};

/// What is known of the values of nodes.
class Ranges {
  public:
    /// Of a quantity or a parameter: its values; of a vector its length.
    void set(const Expr* leaf, const Interval& values) { m_known[leaf] = values; }
    /// Infinite where nothing bounds a value.
    Interval of(const Expr& e);

  private:
    Interval computed(const Expr& e);
    std::map<const Expr*, Interval, ByAge> m_known;
};

/// A subexpression as a table over one or two others.
struct TableCut {
    std::vector<const Expr*> args;
};

/// What a table costs besides texels: nothing, passes of its own, or it cannot be had.
enum class TablePrice { fetch, passes, none };

/// What the combiners cannot do becomes tables: the cheapest way to compute `roots`, all scalars of
/// the pixel, from dot products, values of the pixel and quantities. As in technology mapping for
/// look-up tables (Cong and Ding, FlowMap, 1994), every node has cuts of at most two nodes below it
/// that determine it; a node is computed by combiners from its arguments, or looked up by a cut.
class Cover {
  public:
    /// @param numbers  how fine tables can be
    /// @param tables  without them only powers of two can be had, by squaring
    Cover(const std::vector<const Expr*>& roots, Ranges& ranges, NumberModel numbers,
          TablePrice tables);

    /// How a node that is not a leaf is computed: null by the combiners.
    [[nodiscard]] const TableCut* table(const Expr& e) const;
    /// Nodes that are tables, arguments before what needs them.
    [[nodiscard]] const std::vector<const Expr*>& tables() const { return m_tables; }

  private:
    struct Way {
        double cost = 0.0;
        /// Of a table: how far off it is, what its arguments are off included, and how high.
        double error = 0.0, height = 0.0;
        bool is_table = false;
        TableCut cut;
    };
    const Way& best(const Expr& e);
    const std::vector<NodeSet>& cuts(const Expr& e);
    void choose(const Expr& e);
    /// Without its errors, what a fetch by a cut costs: infinite where it cannot be had.
    double cost_of_fetch(const Expr& e, const NodeSet& cut);
    /// How `e` is looked up by a cut.
    Way looked_up(const Expr& e, const NodeSet& cut, double cost);
    [[nodiscard]] bool bounded(const Expr& e);
    [[nodiscard]] bool is_inverse(const Expr& e);

    Ranges& m_ranges;
    NumberModel m_numbers;
    TablePrice m_price;
    std::map<const Expr*, Way, ByAge> m_best;
    std::map<const Expr*, std::vector<NodeSet>, ByAge> m_cuts;
    NodeSet m_chosen;
    std::vector<const Expr*> m_tables;
};

/// How many times x must be squared for x^exponent; -1 where that does not give it.
int squarings(double exponent);

}  // namespace burnish
