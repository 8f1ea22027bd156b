#pragma once

#include <vector>

#include "shade/attributes.hpp"
#include "shade/shading.hpp"

namespace burnish {

/// What the attributes stage and the input operations of a shading mean, in double precision for
/// one fragment: attributes from the vertices' own, light without rounding, filter weights of any
/// fineness, colours that are not coded.
class ExactInputs {
  public:
    /// Interpolates what the triangle's corners have.
    ExactInputs(const Shading& shading, const SetupTriangle& triangle, const Barycentrics& place);

    /// Operations come in the order of shading.inputs.
    void feed(const InputOp& op);

    [[nodiscard]] double attribute(int k) const {
        return m_attributes[static_cast<std::size_t>(k)];
    }
    void set_attribute(int k, double value) { m_attributes[static_cast<std::size_t>(k)] = value; }
    /// What register plane k stands for.
    [[nodiscard]] double plane(int k) const { return m_planes[static_cast<std::size_t>(k)]; }
    /// Coordinates of the last address, after the division by q.
    [[nodiscard]] double u() const { return m_u; }
    [[nodiscard]] double v() const { return m_v; }

  private:
    /// What a colour, as texels deliver it, stands for.
    static double number(double color, Reading reading);

    void light(const LightingCtx& ctx);
    void locate(const AddressCtx& ctx);
    void fetch(const FetchCtx& ctx);

    const Shading& m_shading;
    std::vector<double> m_attributes, m_planes;
    AddressCtx m_address{};
    double m_u = 0.0, m_v = 0.0;
};

/// Texture unit whose texels go to the register planes from `plane` on.
std::size_t unit_of_plane(const Shading& shading, int plane);

}  // namespace burnish
