#pragma once

#include <burnish/scene.hpp>
#include <functional>
#include <map>
#include <vector>

#include "models/cover.hpp"
#include "models/layer.hpp"
#include "models/make_plan.hpp"
#include "models/terms.hpp"
#include "models/texel_quantities.hpp"

namespace burnish {

/// The model of a material as a sum, with what its quantities are over all texels: what is the same
/// for all machines and lights.
class MaterialTerms {
  public:
    /// Throws Error{bad_program} for a model that cannot be bounded, and what TexelSource throws.
    /// `stop` as TexelSource has it.
    explicit MaterialTerms(const Material& material, std::function<bool()> stop = {});
    MaterialTerms(const MaterialTerms&) = delete;
    MaterialTerms& operator=(const MaterialTerms&) = delete;

    [[nodiscard]] const std::vector<ModelTerm>& terms() const { return m_terms; }
    /// The scalars of the terms.
    [[nodiscard]] std::vector<const Expr*> roots() const;
    [[nodiscard]] const std::map<const Expr*, QuantityValues, ByAge>& quantities() const {
        return m_quantities;
    }
    /// Quantities that are constants of the terms because they do not vary.
    [[nodiscard]] const std::vector<LayerQuantity>& constants() const { return m_constants; }
    [[nodiscard]] double most_tilt() const { return m_most_tilt; }  ///< as in PlanTask
    [[nodiscard]] bool varies() const { return m_source.varies(); }

    Ranges& ranges() { return m_ranges; }
    TexelQuantities& texels() { return m_texels; }

  private:
    void look_at_texels(const std::string& material);

    ExprBuilder m_builder;
    ExprPtr m_value;
    TexelSource m_source;
    TexelQuantities m_texels;
    std::map<const Expr*, QuantityValues, ByAge> m_quantities;
    double m_most_tilt = 0.0;
    std::vector<LayerQuantity> m_constants;
    std::vector<ModelTerm> m_terms;
    Ranges m_ranges;
};

}  // namespace burnish
