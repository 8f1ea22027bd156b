#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shade/attributes.hpp"
#include "shade/shading.hpp"

namespace burnish {

/// What the attributes stage and the input operations of a shading mean, in double precision for
/// one fragment: attributes from the vertices' own, light without rounding, filter weights of any
/// fineness, colours that are not coded.
class ExactInputs {
  public:
    /// Interpolates what the triangle's corners have at pixel (x, y) of the window.
    ExactInputs(const Shading& shading, const ScreenMesh& mesh, const SetupTriangle& triangle,
                std::int32_t x, std::int32_t y);

    /// Operations come in the order of shading.inputs. What a quad covers, QuadFootprintCtx, is for
    /// the caller to set.
    void feed(const InputOp& op);
    /// A table at coordinates that are registers' numbers.
    void look_up(const LookUpTableCtx& ctx, double s, double t);

    [[nodiscard]] double attribute(int k) const {
        return m_attributes[static_cast<std::size_t>(k)];
    }
    void set_attribute(int k, double value) { m_attributes[static_cast<std::size_t>(k)] = value; }
    /// What register plane k stands for.
    [[nodiscard]] double plane(int k) const { return m_planes[static_cast<std::size_t>(k)]; }
    /// Coordinates of the last address, after the division by q.
    [[nodiscard]] double u() const { return m_u; }
    [[nodiscard]] double v() const { return m_v; }
    [[nodiscard]] double r() const { return m_r; }

  private:
    /// What a colour, as texels deliver it, stands for.
    static double number(double color, Reading reading);

    void light(const LightingCtx& ctx);
    void locate(const AddressCtx& ctx);
    void locate(const LevelAddressCtx& ctx);
    void find_face(const CubeFaceCtx& ctx);
    void measure(const FootprintCtx& ctx);
    void fetch(const Texture& texture, int plane, int channels);

    /// A texel of an axis and the weight of its neighbour.
    struct Position {
        int texel;
        double weight;
    };
    static Position position(double u, int size, AddressMode mode, bool linear, bool rectangle);

    const Shading& m_shading;
    std::vector<double> m_attributes, m_planes;
    /// Interpolated attributes over w, and 1/w as the first: here, one pixel right, one down.
    std::array<std::vector<double>, 3> m_over_w;
    double m_u = 0.0, m_v = 0.0, m_r = 0.0;
    // What the last address found.
    int m_level = 0, m_layer = 0;
    Position m_column{}, m_row{};
};

/// The texture that a fetch reads.
const Texture& texture_at(const Shading& shading, const std::uint8_t* texels);

/// Which level an address takes for a level of detail; numbers of levels and 1/256 levels.
int chosen_level(const LevelAddressCtx& ctx, int lod);

/// The slice behind slice `at`.
int slice_behind(int at, int depth, AddressMode mode);

}  // namespace burnish
