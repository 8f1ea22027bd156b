#pragma once

#include <array>
#include <burnish/combiner.hpp>
#include <burnish/machine.hpp>
#include <burnish/texture.hpp>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "models/cover.hpp"
#include "models/expression.hpp"

/// A model as operations of combiners and tables, before it has stages and registers.
namespace burnish {

/// How a value of a plan comes about.
enum class PlanOp {
    input,       ///< of the interpolators: a vector, coded x/2 + 1/2, or a number of 0 .. 1
    quantity,    ///< of the material layer; vectors coded likewise
    constant,    ///< 0 .. 1
    arithmetic,  ///< one or two products, summed, times a power of two
    table,       ///< a fetch
};

/// A value as an operand.
struct PlanInput {
    int value = -1;
    Mapping mapping = Mapping::signed_identity;

    friend bool operator==(const PlanInput&, const PlanInput&) = default;
};

/// The number that a register holds is the value divided by `unit`.
struct PlanValue {
    PlanOp op = PlanOp::arithmetic;
    ValueKind kind = ValueKind::scalar;
    double unit = 1.0;
    bool is_signed = true;  ///< it may be negative
    std::string name;       ///< inputs: "h", "l", "v", "n_dot_l", "h_dot_l", "lit"
    int index = -1;         ///< of the quantity or of the table
    glm::dvec3 constant{0.0};
    // arithmetic: (a b [+ c d]) 2^doublings
    std::array<PlanInput, 4> factors{};
    int products = 1;
    bool is_dot = false;
    int doublings = 0;  ///< -1 .. 2
};

/// An axis of a table: coordinates run from -1 or 0 to 1; there the argument is unit *
/// mapping(coordinate), or two to the power of low + that.
struct PlanAxis {
    std::string name;  ///< of the argument, in the language of models
    PlanInput input;
    double unit = 1.0;
    bool is_signed = false;
    bool logarithmic = false;
    double low = 0.0;
    int size = 1;              ///< texels; the first and the last are the ends
    bool of_material = false;  ///< the argument is a quantity
    CoordinateRange range;     ///< of the argument, whatever texels there are
    [[nodiscard]] double argument(int texel) const;
    [[nodiscard]] double between(int texel) const;  ///< halfway to the next texel

  private:
    [[nodiscard]] double at(double position) const;
};

/// A function of one or two arguments, for a fetch.
struct PlanTable {
    std::string function;  ///< in the language of models
    std::vector<PlanAxis> axes;
    std::vector<double> values;  ///< row after row; of -1 .. 1 times unit
    double unit = 1.0;
    bool coded = false;          ///< texels are x/2 + 1/2, because some are negative
    double interpolation = 0.0;  ///< largest error halfway between texels that was seen
};

/// A quantity of the material layer as the program wants it: divided by `unit`, component by
/// component; vectors, and numbers of both signs, then coded x/2 + 1/2.
struct PlanQuantity {
    std::string name;
    const Expr* expr = nullptr;
    ValueKind kind = ValueKind::scalar;
    glm::dvec3 unit{1.0};
    bool is_signed = false;    ///< scalars: x/2 + 1/2
    bool logarithmic = false;  ///< scalars: log2, from `low` on, unit octaves
    double low = 0.0;

    [[nodiscard]] bool is_coded() const { return kind == ValueKind::vector || is_signed; }
};

/// The final combiner: a (e f) + d, or a b + d. Zero where nothing is named.
struct PlanFinal {
    PlanInput a, b, d, e, f;
    bool has_product = false;  ///< b is e f
};

struct Plan {
    std::vector<PlanValue> values;
    std::vector<PlanTable> tables;
    std::vector<PlanQuantity> quantities;
    glm::dvec3 half_scale{1.0};
    PlanFinal final;
    glm::dvec3 lit_tint{0.0}, lit_base{0.0};  ///< of the input "lit": n_dot_l * tint + base
};

}  // namespace burnish
