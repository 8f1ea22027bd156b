#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/quantiser.hpp"
#include "machine/interpreter.hpp"
#include "shade/attributes.hpp"
#include "shade/shading.hpp"
#include "trace/table_grid.hpp"

namespace burnish {

/// What rounds the numbers that come to the registers of a program in double precision.
struct InputRounding {
    Quantiser* quantiser = nullptr;  ///< null: nothing is rounded
    /// coded_planes of the shading: these are rounded as Quantiser::coded_number does; null: none.
    const std::vector<bool>* coded = nullptr;
    int vectors = kExactBits;  ///< of interpolators and lighting
    int texels = kExactBits;
    int filter = kExactBits;  ///< each lerp, and the fraction of its weight, cut off downwards
    int table = kExactBits;   ///< of texels at computed coordinates: 2^b along an axis, of b bits
    const TableGrid* grid = nullptr;  ///< of models' tables; null: as TableGrid is made
};

/// What the attributes stage and the input operations of a shading mean, in double precision for
/// one fragment: attributes from the vertices' own, light without rounding, filter weights of any
/// fineness, colours that are not coded. Numbers are rounded where `rounding` says so.
class ExactInputs {
  public:
    /// Interpolates what the triangle's corners have at pixel (x, y) of the window.
    ExactInputs(const Shading& shading, const ScreenMesh& mesh, const SetupTriangle& triangle,
                std::int32_t x, std::int32_t y, const InputRounding& rounding = {});

    /// Operations come in the order of shading.inputs. What a quad covers, QuadFootprintCtx, is for
    /// the caller to set, and ProbedCtx for feed_probes().
    void feed(const InputOp& op);
    /// Those of shading.inputs one after the other, for each of this fragment's probes where there
    /// are some.
    void feed_all(std::span<const InputOp> ops);
    /// `ops` once for every probe, and the means of what they bring.
    void feed_probes(const ProbedCtx& probed, std::span<const InputOp> ops);
    /// Moves the coordinates of corners to one of the texels around the sample point, a hair behind
    /// its centre, so that other operations find nothing but that texel.
    void stand_at(const TexelCornerCtx& corner);
    /// What the right and the lower texels around the sample point weigh; known after stand_at.
    [[nodiscard]] std::array<double, 2> corner_weights() const { return m_corner_weights; }
    /// Registers before the program; units that are off read (0, 0, 0, 1), those without a result
    /// (0, 0, 0, 0).
    [[nodiscard]] RealRegisters registers() const;
    /// The texel of fetch `number` between stages, at coordinates that are registers' numbers.
    /// @param footprint  what a quad covers, if the fetch asks for it; of a summed table half of
    ///                   how much its first coordinate changes there
    Reals fetch_between_stages(std::size_t number, const std::array<double, 3>& at,
                               double footprint = 0.0);

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

    void look_up(const LookUpTableCtx& ctx, double s, double t);
    void average(const AverageTableCtx& ctx, double s, double t, double half);
    /// The mean of a row of a table over its first coordinate, whose function is made of lerps.
    [[nodiscard]] static double mean_of_row(const Texture& table, int row, double low, double high);
    void light(const LightingCtx& ctx);
    void locate(const AddressCtx& ctx);
    void locate(const LevelAddressCtx& ctx);
    void find_face(const CubeFaceCtx& ctx);
    void measure(const FootprintCtx& ctx);
    void measure(const ProbeExtentCtx& ctx);
    void fetch(const Texture& texture, int plane, int channels);

    /// A texel of an axis and the weight of its neighbour.
    struct Position {
        int texel;
        double weight;
    };
    static Position position(double u, int size, AddressMode mode, bool linear, bool rectangle);
    /// Along an axis of a table.
    Position position_along(const LookUpTableCtx::Axis& axis, double at);
    /// The same, on the grid of a table if the coordinate was computed.
    Position table_position(double u, int size, AddressMode mode, bool linear, bool rectangle);
    /// Two texels of a model's table on the grid of InputRounding::grid, as positions in the table
    /// that the program has.
    struct GridPlace {
        Position low, high;
        double weight;
    };
    GridPlace grid_place(const LookUpTableCtx& ctx, std::size_t axis, double at);
    [[nodiscard]] int table_values() const;
    [[nodiscard]] bool is_texel(std::int32_t width, std::int32_t height) const {
        return m_corner_size == std::array{width, height};
    }
    /// The weight of a lerp as its filter has it.
    [[nodiscard]] double cut(double weight) const;
    /// A number for `plane`, or a channel of a texel.
    double rounded(double x, int plane, bool is_signed, int bits);

    const Shading& m_shading;
    InputRounding m_rounding;
    std::vector<double> m_attributes, m_planes;
    /// Interpolated attributes over w, and 1/w as the first: here, one pixel right, one down.
    std::array<std::vector<double>, 3> m_over_w;
    double m_u = 0.0, m_v = 0.0, m_r = 0.0;
    // What the last address found.
    int m_level = 0, m_layer = 0;
    Position m_column{}, m_row{};
    std::array<double, 2> m_corner_weights{};
    std::array<std::int32_t, 2> m_corner_size{};  ///< of the level that the corner is a texel of
    bool m_is_texel = false;  ///< the last address is that of a corner's own texel
    bool m_is_table = false;  ///< coordinates were computed from texels, registers or light
};

/// A plane with the value that all channels of a table have, of which only those that are read have
/// a plane.
int any_output(std::span<const int, 4> out);

/// The texture that a fetch reads.
const Texture& texture_at(const Shading& shading, const std::uint8_t* texels);

/// Which level an address takes for a level of detail; numbers of levels and 1/256 levels.
int chosen_level(LevelChoice choice, int level_count, int lod);

/// The slice behind slice `at`.
int slice_behind(int at, int depth, AddressMode mode);

}  // namespace burnish
