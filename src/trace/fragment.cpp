#include "trace/fragment.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "shade/attributes.hpp"
#include "trace/exact_inputs.hpp"
#include "trace/interpolants.hpp"
#include "trace/texel_bytes.hpp"

namespace burnish {

namespace {

/// The scalar kernels on a packet of one fragment, which lies at the tile's first pixel.
class LonePacket {
  public:
    LonePacket(const Shading& shading, const ScreenMesh& mesh, const SetupTriangle& triangle,
               std::int32_t x, std::int32_t y)
        : m_attributes(static_cast<std::size_t>(kMaxAttributes) * kAttributeStride),
          m_planes(static_cast<std::size_t>(shading.program.plane_count) * kPacketSize),
          m_equations(kMaxInterpolated + 1) {
        const AttributePlane constant{1.0F, 0.0F, 0.0F};
        attribute_planes(shading, mesh, triangle, m_equations.data());
        m_run = {m_equations.data(), 0, 1, x - triangle.reference_x, y - triangle.reference_y};
        // Divided by the constant 1, the plane of 1/w shows itself.
        const AttributePlane only[2] = {constant, m_equations.front()};
        Run alone = m_run;
        alone.planes = only;
        table_reference().attributes(m_packet, {&alone, 1, 1});
        m_one_over_w = attribute(0);
        m_runs = {&m_run, 1, shading.interpolated()};
        table_reference().attributes(m_packet, m_runs);
    }
    LonePacket(const LonePacket&) = delete;
    LonePacket& operator=(const LonePacket&) = delete;
    LonePacket(LonePacket&&) = delete;
    LonePacket& operator=(LonePacket&&) = delete;
    ~LonePacket() = default;

    [[nodiscard]] const AttributesCtx& runs() const { return m_runs; }
    Packet& packet() { return m_packet; }
    [[nodiscard]] float attribute(int k) const {
        return m_attributes[static_cast<std::size_t>(k) * kAttributeStride];
    }
    [[nodiscard]] int plane(int k) const {
        return m_planes[static_cast<std::size_t>(k) * kPacketSize];
    }
    [[nodiscard]] float one_over_w() const { return m_one_over_w; }
    [[nodiscard]] std::int32_t texel() const { return m_texel[0]; }
    [[nodiscard]] int weight_x() const { return m_weight_x[0]; }
    [[nodiscard]] int weight_y() const { return m_weight_y[0]; }

  private:
    AlignedVector<float> m_attributes;
    AlignedVector<std::int16_t> m_planes;
    std::vector<AttributePlane> m_equations;
    Run m_run{};
    AttributesCtx m_runs{};
    std::uint16_t m_pixel[1] = {0};
    std::int32_t m_texel[1] = {0};
    std::int16_t m_weight_x[1] = {0}, m_weight_y[1] = {0};
    float m_one_over_w = 0.0F;
    Packet m_packet{1,       m_pixel,    m_attributes.data(), m_planes.data(),
                    m_texel, m_weight_x, m_weight_y};
};

TracedNumber number(float value, double exact) {
    return {static_cast<double>(value), exact};
}

/// The neighbour that a texture keeps beside texel `at` of `size`; -1 and `size` are border texels.
int neighbour(int at, int size, Wrap wrap) {
    if (at + 1 < size || wrap == Wrap::clamp_to_border) return at + 1;
    return wrap == Wrap::repeat ? 0 : size - 1;
}

/// Runs the input operations of a shading and notes what they give.
class InputTracer {
  public:
    InputTracer(const Shading& shading, LonePacket& packet, ExactInputs& exact)
        : m_shading(shading), m_packet(packet), m_exact(exact) {}

    void run(TracedFragment& out) {
        for (const InputOp& op : m_shading.inputs) {
            feed_input(op, m_shading.program.numbers, table_reference(), m_packet.runs(),
                       m_packet.packet());
            m_exact.feed(op);
            note(op, out);
        }
        for (const InterpolantPlanes& group : interpolant_planes(m_shading)) {
            TracedInterpolant traced{group.name, group.components, {}};
            for (const int plane : group.planes) {
                traced.numbers.push_back(
                    number(m_packet.attribute(plane), m_exact.attribute(plane)));
            }
            out.interpolants.push_back(std::move(traced));
        }
    }

    /// Registers before the program; units that are off read (0, 0, 0, 1).
    [[nodiscard]] FragmentInputs registers() const {
        FragmentInputs result;
        for (auto& filled : result.filled.values) filled.fill(true);
        const BoundProgram& program = m_shading.program;
        for (const Register reg : {Register::col0, Register::col1}) {
            for (std::size_t c = 0; c < 4; ++c) take(reg, c, result);
        }
        for (int unit = 0; unit < 16; ++unit) {
            const auto index = static_cast<std::size_t>(unit);
            const bool enabled = index < m_shading.textures.size() && m_shading.textures[index];
            if (!enabled) {
                result.codes[tex(unit)][3] = code_of_one(program.numbers);
                result.exact[tex(unit)][3] = 1.0;
                continue;
            }
            for (std::size_t c = 0; c < 4; ++c) take(tex(unit), c, result);
        }
        result.filled[Register::spare0][3] = result.filled[Register::tex0][3];
        return result;
    }

  private:
    void take(Register reg, std::size_t c, FragmentInputs& to) const {
        const int plane = m_shading.program.input[static_cast<std::size_t>(reg)][c];
        to.filled[reg][c] = plane >= 0;
        if (plane < 0) return;
        to.codes[reg][c] = m_packet.plane(plane);
        to.exact[reg][c] = m_exact.plane(plane);
    }

    void note(const InputOp& op, TracedFragment& out) {
        if (const auto* address = std::get_if<AddressCtx>(&op)) {
            m_level = {};
            m_level.u = address->u;
            m_level.v = address->v;
            m_level.q = address->q;
            m_level.r = m_level.lambda = -1;
        } else if (const auto* level = std::get_if<LevelAddressCtx>(&op)) {
            m_level = *level;
        } else if (const auto* fetch = std::get_if<FetchCtx>(&op)) {
            for (int k = 0; k < fetch->count; ++k) {
                add_fetch(texture_at(m_shading, fetch->texels[k]), fetch->plane[k], out);
            }
        } else if (const auto* words = std::get_if<FetchWordsCtx>(&op)) {
            add_fetch(texture_at(m_shading, words->texels), words->plane, out);
        } else if (const auto* blend = std::get_if<BlendLevelsCtx>(&op)) {
            add_blend(*blend, out);
        }
    }

    /// The unit whose registers begin at `plane`.
    [[nodiscard]] std::optional<int> unit_of_plane(int plane) const {
        for (int unit = 0; unit < static_cast<int>(m_shading.textures.size()); ++unit) {
            const auto reg = static_cast<std::size_t>(tex(unit));
            if (m_shading.program.input[reg][0] == plane) return unit;
        }
        return std::nullopt;
    }

    void set_color(int plane, TracedFetch& fetch) const {
        const double one = code_of_one(m_shading.program.numbers);
        for (int c = 0; c < 4; ++c) {
            const auto at = static_cast<std::size_t>(c);
            fetch.codes[at] = m_packet.plane(plane + c);
            fetch.color[at] = {fetch.codes[at] / one, m_exact.plane(plane + c)};
        }
    }

    void add_fetch(const Texture& texture, int plane, TracedFragment& out) {
        const TracedTaps taps = taps_of(texture);
        const std::optional<int> unit = unit_of_plane(plane);
        if (!unit) {  // of a level or slice that is to be blended with others
            m_scratch[plane] = {taps};
            return;
        }
        TracedFetch fetch;
        static_cast<TracedTaps&>(fetch) = taps;
        fetch.unit = *unit;
        fetch.width = texture.width();
        fetch.height = texture.height();
        fetch.sampler = texture.sampler();
        fetch.target = texture.target();
        const float q = m_level.q < 0 ? 1.0F : m_packet.attribute(m_level.q);
        fetch.u = number(m_packet.attribute(m_level.u) / q, m_exact.u());
        fetch.v = number(m_packet.attribute(m_level.v) / q, m_exact.v());
        if (m_level.r >= 0) fetch.r = number(m_packet.attribute(m_level.r) / q, m_exact.r());
        if (m_level.lambda >= 0) {
            fetch.lod = {m_packet.plane(m_level.lambda) / 256.0, m_exact.plane(m_level.lambda)};
        }
        set_color(plane, fetch);
        out.fetches.push_back(std::move(fetch));
    }

    void add_blend(const BlendLevelsCtx& ctx, TracedFragment& out) {
        const std::optional<int> unit = unit_of_plane(ctx.out);
        const auto fetch = std::find_if(out.fetches.begin(), out.fetches.end(),
                                        [&](const TracedFetch& f) { return unit == f.unit; });
        std::vector<TracedTaps>& to = unit ? fetch->further : m_scratch[ctx.out];
        const std::vector<TracedTaps>& from = m_scratch[ctx.b];
        to.insert(to.end(), from.begin(), from.end());
        if (unit) set_color(ctx.out, *fetch);
    }

    [[nodiscard]] TracedTaps taps_of(const Texture& texture) const {
        TracedTaps taps;
        const int lod = m_level.lambda < 0 ? 0 : m_packet.plane(m_level.lambda);
        taps.level = m_level.level_count == 0 ? 0 : chosen_level(m_level, lod);
        const TextureLevel& level = texture.levels()[static_cast<std::size_t>(taps.level)];
        // A row and a column of border may lie before the first texel.
        const std::int32_t margin = texture.pitch() + texture.texel_bytes();
        const std::int32_t offset =
            m_packet.texel() - level.offset + margin + texture.layer_bytes();
        taps.layer = offset / texture.layer_bytes() - 1;
        const std::int32_t in_layer = offset % texture.layer_bytes();
        taps.y0 = in_layer / texture.pitch() - 1;
        taps.x0 = in_layer % texture.pitch() / texture.texel_bytes() - 1;
        taps.x1 = neighbour(taps.x0, level.width, texture.sampler().wrap_s);
        taps.y1 = neighbour(taps.y0, level.height, texture.sampler().wrap_t);
        taps.weight_x = m_packet.weight_x();
        taps.weight_y = m_packet.weight_y();
        for (int tap = 0; tap < 4; ++tap) {
            for (int c = 0; c < 4; ++c) {
                taps.taps[static_cast<std::size_t>(tap)][static_cast<std::size_t>(c)] = texel_bits(
                    texture, taps.level, taps.layer, taps.x0 + tap % 2, taps.y0 + tap / 2, c);
            }
        }
        return taps;
    }

    const Shading& m_shading;
    LonePacket& m_packet;
    ExactInputs& m_exact;
    std::map<int, std::vector<TracedTaps>> m_scratch;  ///< what scratch planes were made from
    LevelAddressCtx m_level{};                         ///< of plain addresses the coordinates only
};

}  // namespace

FragmentInputs trace_inputs(const Draw& draw, const SetupTriangle& triangle, std::int32_t x,
                            std::int32_t y, TracedFragment& out) {
    const Barycentrics place = barycentrics(draw.mesh(), triangle, x, y);
    LonePacket packet(draw.shading, draw.mesh(), triangle, x, y);
    ExactInputs exact(draw.shading, draw.mesh(), triangle, x, y);
    out.barycentrics = place.weight;
    out.one_over_w = number(packet.one_over_w(), place.one_over_w);
    InputTracer tracer(draw.shading, packet, exact);
    tracer.run(out);
    return tracer.registers();
}

}  // namespace burnish
