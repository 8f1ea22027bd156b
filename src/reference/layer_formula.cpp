#include "reference/layer_formula.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "models/model_texts.hpp"
#include "models/terms.hpp"
#include "reference/surface_sampler.hpp"

namespace burnish::reference {

namespace {

class NamedModel : public LayerFormula {
  public:
    NamedModel(const Material& material, const std::vector<LayerQuantity>& layer)
        : m_model(material.model), m_surface(layer_surface(material, layer)) {}

    [[nodiscard]] glm::dvec3 at(const glm::dvec2& uv, const Directions& to) override {
        return reflected(m_model, m_surface->at(uv), to);
    }

  private:
    Model m_model;
    std::unique_ptr<SurfaceSampler> m_surface;
};

class TextModel : public LayerFormula {
  public:
    TextModel(const Material& material, std::vector<LayerQuantity> layer)
        : m_layer(std::move(layer)),
          m_value(model_expression(material, m_builder)),
          m_quantities(quantities_of(*m_value)),
          m_tape({m_value.get()}, inputs()) {}

    [[nodiscard]] glm::dvec3 at(const glm::dvec2& uv, const Directions& to) override {
        m_inputs.clear();
        for (const Expr* quantity : m_quantities) m_inputs.push_back(value_of(*quantity, uv));
        m_inputs.insert(m_inputs.end(), {to.l, to.v, to.h, glm::dvec3(std::max(0.0, to.l.z)),
                                         glm::dvec3(std::max(0.0, to.h_l))});
        glm::dvec3 value;
        m_tape.run(m_inputs.data(), &value);
        return value;
    }

  private:
    static constexpr std::array<std::string_view, 5> kGeometry{"l", "v", "h", "n_dot_l", "h_dot_l"};

    std::vector<const Expr*> inputs() {
        std::vector<const Expr*> nodes = m_quantities;
        for (const std::string_view name : kGeometry) {
            m_geometry.push_back(m_builder.leaf(name));
            nodes.push_back(m_geometry.back().get());
        }
        return nodes;
    }

    [[nodiscard]] glm::dvec3 value_of(const Expr& quantity, const glm::dvec2& uv) const {
        const auto at = std::find_if(m_layer.begin(), m_layer.end(), [&](const LayerQuantity& q) {
            return q.name == quantity.name;
        });
        if (at == m_layer.end()) return glm::dvec3(0.0);
        const glm::dvec3 value =
            at->texture ? at->decoded(sample_texture(*at->texture, uv, at->channel, at->components))
                        : at->constant;
        return at->components == 1 ? glm::dvec3(value.x) : value;
    }

    std::vector<LayerQuantity> m_layer;
    ExprBuilder m_builder;
    ExprPtr m_value;
    std::vector<const Expr*> m_quantities;
    std::vector<ExprPtr> m_geometry;
    Tape m_tape;
    std::vector<glm::dvec3> m_inputs;
};

}  // namespace

std::unique_ptr<LayerFormula> layer_formula(const Material& material,
                                            std::vector<LayerQuantity> layer) {
    if (material.model == Model::text)
        return std::make_unique<TextModel>(material, std::move(layer));
    return std::make_unique<NamedModel>(material, layer);
}

}  // namespace burnish::reference
