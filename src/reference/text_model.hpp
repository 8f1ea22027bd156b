#pragma once

#include <burnish/scene.hpp>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "models/expression.hpp"
#include "models/layer.hpp"
#include "models/texel.hpp"
#include "reference/level_of_detail.hpp"
#include "reference/shade.hpp"

namespace burnish::reference {

/// An expression as a list of operations in double precision, by the C library's functions: what
/// Tape is to the machines' tables, without its code. Roots and powers of negative numbers are 0.
class Formula {
  public:
    /// @param leaves  whose values the caller gives; whatever else has no arguments is a constant
    Formula(const Expr& value, const std::vector<const Expr*>& leaves);

    /// For values of the leaves in their order; numbers in all three components.
    [[nodiscard]] glm::dvec3 operator()(std::vector<glm::dvec3> leaves) const;

  private:
    struct Step {
        ExprOp op;
        glm::dvec3 constant;
        std::size_t a, b;  ///< leaves, then steps before this one
    };
    std::size_t m_leaves, m_value;
    std::vector<Step> m_steps;
};

/// The values of a text's quantities at one point, in its order; numbers in all three components.
struct TextSurface {
    std::vector<glm::dvec3> values;
};

TextSurface operator*(TextSurface surface, double factor);
TextSurface operator+(TextSurface a, const TextSurface& b);

/// A material whose model is a text. Quantities are computed texel by texel and filtered, as those
/// of SurfaceSampler.
class TextModel {
  public:
    /// `stop` as TexelSource has it. Throws Error{bad_program} for a text with errors, and what
    /// TexelSource throws.
    explicit TextModel(const Material& material, const std::function<bool()>& stop = {});
    /// Quantities as they stand in the textures of a machine's layer; those that it does without
    /// are exact.
    TextModel(const Material& material, std::span<const LayerQuantity> layer);

    [[nodiscard]] TextSurface at(const glm::dvec2& uv, const CoordinateSteps& steps = {}) const;

    /// What a light of colour 1 adds. Values below 0, and what is no number, are 0.
    [[nodiscard]] glm::dvec3 reflected(const TextSurface& surface, const Directions& to) const;

  private:
    [[nodiscard]] TextSurface exact(const glm::dvec2& uv, const CoordinateSteps& steps) const;
    [[nodiscard]] TextSurface texel(const TexelParameters& parameters) const;
    void find_extremes();

    TexelSource m_source;
    bool m_has_mipmaps;
    ExprPtr m_value;  ///< keeps the nodes alive
    std::vector<const Expr*> m_quantities, m_parameters, m_geometry;
    std::vector<Formula> m_definitions;  ///< of the quantities, by the parameters
    std::optional<Formula> m_formula;    ///< by the quantities and what varies from pixel to pixel
    /// Of quantities that are the least or the largest of all texels.
    std::vector<std::pair<std::size_t, glm::dvec3>> m_extremes;
    std::vector<std::optional<LayerQuantity>> m_layer;  ///< of the quantities, or empty
    std::optional<TextSurface> m_constant;              ///< without maps
};

}  // namespace burnish::reference
