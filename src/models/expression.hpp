#pragma once

#include <burnish/scene.hpp>
#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

/// A reflectance model as an expression: what the compiler of models works on.
namespace burnish {

/// What a value is. A scalar times a vector or a colour is a vector or a colour.
enum class ValueKind { scalar, vector, color };

/// When a value is known: for all pixels, at every texel of the material's maps, or at every pixel.
enum class Binding { constant, texel, pixel };

enum class ExprOp {
    constant,
    parameter,  ///< of the material: texel binding
    geometry,   ///< of the pixel: l, v, h, n_dot_l, h_dot_l
    /// A named expression of parameters: one quantity of the material layer. Of texel binding, what
    /// is made of it may be another quantity; of pixel binding (`filtered`), it is what the filter
    /// gives.
    quantity,
    add,
    multiply,
    divide,
    dot,
    power,
    square_root,
    exponential,
    minimum,
    maximum,
};

/// A number that all values of a quantity have in common.
enum class Extreme { none, least, most };

struct Expr;
using ExprPtr = std::shared_ptr<const Expr>;

/// A node. Equal subexpressions of one ExprBuilder are one node.
struct Expr {
    ExprOp op;
    ValueKind kind;
    Binding binding;
    glm::dvec3 value{0.0};  ///< of a constant; a scalar in every component
    std::string name;       ///< of leaves and quantities
    std::vector<ExprPtr> args;
    ExponentCoding coding = ExponentCoding::automatic;  ///< of a quantity that is the exponent
    Extreme extreme = Extreme::none;  ///< of a quantity: not itself, but that of all texels
    std::size_t column = 0;           ///< from 1, where the text has it first
    std::size_t line = 1;
    std::size_t id = 0;  ///< in the order in which nodes were made
};

/// An order that does not depend on addresses.
struct ByAge {
    bool operator()(const Expr* a, const Expr* b) const { return a->id < b->id; }
};

/// Makes nodes: folds constants, shares what is equal, brings texel factors into dot products.
class ExprBuilder {
  public:
    ExprBuilder();
    ~ExprBuilder();
    ExprBuilder(const ExprBuilder&) = delete;
    ExprBuilder& operator=(const ExprBuilder&) = delete;

    /// What filters are to see of the quantity that is the exponent alone.
    void code_exponent(ExponentCoding coding) { m_exponent_coding = coding; }
    /// Where the next nodes stand in the text.
    void at(std::size_t line, std::size_t column);

    ExprPtr number(double value);
    ExprPtr constant(ValueKind kind, const glm::dvec3& value);
    /// A parameter, a value of the pixel or an axis of the surface by its name; null for an unknown
    /// one.
    ExprPtr leaf(std::string_view name);
    /// `value`, which depends on parameters only, under a name. Constants stay what they are.
    ExprPtr quantity(std::string name, const ExprPtr& value);
    /// `value`, which depends on parameters only, as the filter gives it at a pixel: what is made
    /// of it is not filtered again. Constants stay what they are.
    ExprPtr filtered(const ExprPtr& value);
    /// The least or the largest number that `value`, a scalar of parameters only, has at any texel.
    ExprPtr extreme(Extreme which, const ExprPtr& value);
    ExprPtr add(const ExprPtr& a, const ExprPtr& b);
    ExprPtr multiply(const ExprPtr& a, const ExprPtr& b);
    /// The same, but the vectors of dot products stay as they are: once quantities have been named.
    ExprPtr product(const ExprPtr& a, const ExprPtr& b);
    ExprPtr divide(const ExprPtr& a, const ExprPtr& b);
    ExprPtr negate(const ExprPtr& a);
    ExprPtr dot(const ExprPtr& a, const ExprPtr& b);
    ExprPtr power(const ExprPtr& base, const ExprPtr& exponent);
    ExprPtr square_root(const ExprPtr& a);
    ExprPtr exponential(const ExprPtr& a);
    ExprPtr minimum(const ExprPtr& a, const ExprPtr& b);
    ExprPtr maximum(const ExprPtr& a, const ExprPtr& b);

    static std::vector<std::string_view> leaf_names();
    /// Constants: unit vectors of the surface.
    static std::vector<std::string_view> axis_names();

  private:
    ExprPtr node(ExprOp op, ValueKind kind, std::vector<ExprPtr> args);
    ExprPtr intern(Expr expr);
    ExprPtr quantity_of(std::string name, const ExprPtr& value, Binding binding, Extreme extreme);
    struct Table;
    std::unique_ptr<Table> m_table;
    std::size_t m_line = 1, m_column = 1;
    ExponentCoding m_exponent_coding = ExponentCoding::automatic;
};

/// Evaluates expressions again and again, in double precision and with the elementary functions
/// that give the same bits everywhere. NaN and infinity are the caller's business.
class Tape {
  public:
    /// @param inputs  nodes whose values the caller gives; nothing below them is looked into.
    /// Leaves
    ///                that are not among them are NaN.
    Tape(const std::vector<const Expr*>& roots, const std::vector<const Expr*>& inputs);

    /// Values of the roots, in their order, for values of the inputs in theirs.
    void run(const glm::dvec3* inputs, glm::dvec3* roots);

  private:
    struct Step {
        ExprOp op;
        std::size_t args[2];
    };
    std::size_t m_inputs;
    std::vector<Step> m_steps;  ///< each fills the next value
    std::vector<glm::dvec3> m_values;
    std::vector<std::size_t> m_roots;
};

/// In the language of models; quantities by their names, numbers with six digits. "..." stands for
/// what is left beyond some 2000 characters.
std::string print_expression(const Expr& expr);

/// x of clamp(x, -c, c) with a constant c > 0, where a register that counts in units of c stops
/// anyway; else null.
const Expr* symmetric_clamp(const Expr& expr);

/// Whether `expr` is the scalar constant `value`.
bool is_number(const Expr& expr, double value);

/// -x, as -1 times x.
bool is_negation(const Expr& expr);

/// 1 - x.
bool is_one_minus(const Expr& expr);

}  // namespace burnish
