#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "models/expression.hpp"
#include "models/texel.hpp"

namespace burnish {

/// The texel's parameters that quantities are made of, each once.
std::vector<const Expr*> parameters_of(const std::vector<const Expr*>& quantities);

/// The values of `quantities` at a texel, for leaves that TexelParameters has.
class TexelTape {
  public:
    explicit TexelTape(const std::vector<const Expr*>& quantities);
    void run(const TexelParameters& texel, glm::dvec3* values);

  private:
    std::vector<glm::dvec3 (*)(const TexelParameters&)> m_readers;  ///< of the tape's inputs
    Tape m_tape;
};

/// Quantities at every texel of a material, for all who look at them: worked out once, and kept up
/// to so many bytes. Rows beyond are worked out whenever somebody asks.
class TexelQuantities {
  public:
    static constexpr std::size_t kMostKept = std::size_t{64} << 20;

    /// @param source  has to outlive this
    /// @param most_kept  in bytes
    TexelQuantities(std::vector<const Expr*> quantities, const TexelSource& source,
                    std::size_t most_kept = kMostKept);

    [[nodiscard]] const TexelSource& source() const { return m_source; }
    [[nodiscard]] const std::vector<const Expr*>& quantities() const { return m_quantities; }

    /// Row 0 <= y < source().height(level): good until the next row. Throws what
    /// TexelSource::require_wanted does where it has to be worked out.
    void seek(int level, int y);
    /// Component `c` of one of quantities(), from left to right. Those of a scalar are all the
    /// same.
    [[nodiscard]] std::span<const double> component(const Expr& quantity, int c) const;
    /// The row's largest |x| or |y| of a normal.
    [[nodiscard]] double tilt() const { return m_row->tilt; }

  private:
    struct Row {
        double tilt = 0.0;
        std::size_t width = 0;
        std::vector<double> values;  ///< component after component
    };
    void work_out(int level, int y, Row& row);

    std::vector<const Expr*> m_quantities;
    const TexelSource& m_source;
    TexelTape m_tape;
    std::vector<std::size_t> m_first;  ///< component of each quantity in a row
    std::size_t m_components = 0;
    std::vector<std::size_t> m_first_row;  ///< of each level, among all rows
    std::vector<Row> m_kept;               ///< the first ones; empty until they are asked for
    Row m_other;
    const Row* m_row = nullptr;
};

}  // namespace burnish
