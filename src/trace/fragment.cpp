#include "trace/fragment.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "shade/attributes.hpp"
#include "trace/exact_inputs.hpp"
#include "trace/interpolants.hpp"
#include "trace/texel_bytes.hpp"
#include "trace/unit_numbers.hpp"

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
    void set_attribute(int k, float value) {
        m_attributes[static_cast<std::size_t>(k) * kAttributeStride] = value;
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
        for (std::size_t i = 0; i < m_shading.inputs.size(); ++i) {
            const InputOp& op = m_shading.inputs[i];
            feed_input(op, m_shading.program.numbers, table_reference(), m_packet.runs(),
                       m_packet.packet());
            m_exact.feed(op);
            add_unit_numbers(i, out);
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

    /// Registers before the program; units that are off read (0, 0, 0, 1), those without a result
    /// (0, 0, 0, 0).
    [[nodiscard]] FragmentInputs registers() const {
        FragmentInputs result;
        for (auto& filled : result.filled.values) filled.fill(true);
        const BoundProgram& program = m_shading.program;
        for (const Register reg : {Register::col0, Register::col1}) {
            for (std::size_t c = 0; c < 4; ++c) take(reg, c, result);
        }
        for (int unit = 0; unit < 16; ++unit) {
            if ((m_shading.unit_states.black >> unit & 1) != 0) continue;
            if ((m_shading.unit_states.enabled >> unit & 1) == 0) {
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
    void add_unit_numbers(std::size_t op, TracedFragment& out) const {
        const int unit = unit_of_operation(m_shading, op);
        const auto numbers = unit_numbers(m_shading.inputs[op], m_shading);
        if (!numbers || unit < 0 || unit >= static_cast<int>(out.units.size())) return;
        TracedInterpolant traced{numbers->name, numbers->components, {}};
        for (const int plane : numbers->planes)
            traced.numbers.push_back(number(m_packet.attribute(plane), m_exact.attribute(plane)));
        out.units[static_cast<std::size_t>(unit)].numbers.push_back(std::move(traced));
    }

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
            if (unit_of_plane(blend->out)) set_color(blend->out, out.fetches.back());
        }
    }

    /// The unit whose texel begins at register plane `plane`.
    [[nodiscard]] std::optional<int> unit_of_plane(int plane) const {
        for (const PlannedUnit& unit : m_shading.units) {
            if (unit.registers == plane) return unit.unit;
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

    void add_fetch(const Texture& texture, int plane, TracedFragment& out) const {
        const TracedTaps taps = taps_of(texture);
        const std::optional<int> unit = unit_of_plane(plane);
        if (!unit) {  // of a level or slice that is blended with those before
            out.fetches.back().further.push_back(taps);
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
    LevelAddressCtx m_level{};  ///< of plain addresses the coordinates only
};

/// One fragment, followed on both kinds of numbers.
struct TwoPackets {
    TwoPackets(const Shading& shading, const ScreenMesh& mesh, const SetupTriangle& triangle,
               std::int32_t x, std::int32_t y)
        : packet(shading, mesh, triangle, x, y), exact(shading, mesh, triangle, x, y) {}
    LonePacket packet;  // points into itself: not to be moved
    ExactInputs exact;
};

/// Serves the fetches between stages, in their order, with the operations that the renderer runs.
/// Coordinates come decoded.
class StageFetches {
  public:
    StageFetches(const Shading& shading, std::shared_ptr<TwoPackets> fragment)
        : m_shading(&shading), m_fragment(std::move(fragment)) {}

    /// The number of the fetch's operations; -1 for a unit without a texture.
    int next(const StageFetch& fetch) {
        const int unit = static_cast<int>(fetch.destination) - static_cast<int>(Register::tex0);
        return (m_shading->unit_states.textured >> unit & 1) == 0 ? -1 : m_next++;
    }
    [[nodiscard]] const std::vector<InputOp>& ops(int fetch) const {
        return m_shading->stage_fetches[static_cast<std::size_t>(fetch)].ops;
    }
    [[nodiscard]] int plane(int fetch, std::size_t c) const {
        return m_shading->program.fetches[static_cast<std::size_t>(fetch)].out +
               static_cast<int>(c);
    }
    [[nodiscard]] const Shading& shading() const { return *m_shading; }
    [[nodiscard]] TwoPackets& fragment() const { return *m_fragment; }

  private:
    const Shading* m_shading;
    std::shared_ptr<TwoPackets> m_fragment;
    int m_next = 0;
};

FetchCodes fetch_codes(StageFetches fetches) {
    return [fetches](const StageFetch& fetch, const std::array<float, 3>& at) mutable {
        const NumberModel numbers = fetches.shading().program.numbers;
        const int number = fetches.next(fetch);
        if (number < 0) return Codes{0, 0, 0, code_of_one(numbers)};
        LonePacket& packet = fetches.fragment().packet;
        std::size_t coordinate = 0;
        for (const InputOp& op : fetches.ops(number)) {
            if (const auto* decode = std::get_if<DecodeCtx>(&op)) {
                packet.set_attribute(decode->attribute, at.at(coordinate++));
            } else {
                feed_input(op, numbers, table_reference(), packet.runs(), packet.packet());
            }
        }
        Codes codes{};
        for (std::size_t c = 0; c < 4; ++c) codes[c] = packet.plane(fetches.plane(number, c));
        return codes;
    };
}

FetchReals fetch_reals(StageFetches fetches) {
    return [fetches](const StageFetch& fetch, const std::array<double, 3>& at) mutable {
        const int number = fetches.next(fetch);
        if (number < 0) return Reals{0.0, 0.0, 0.0, 1.0};
        ExactInputs& exact = fetches.fragment().exact;
        std::size_t coordinate = 0;
        for (const InputOp& op : fetches.ops(number)) {
            if (const auto* decode = std::get_if<DecodeCtx>(&op)) {
                exact.set_attribute(decode->attribute, at.at(coordinate++));
            } else {
                exact.feed(op);
            }
        }
        Reals reals{};
        for (std::size_t c = 0; c < 4; ++c) reals[c] = exact.plane(fetches.plane(number, c));
        return reals;
    };
}

}  // namespace

FragmentInputs trace_inputs(const Draw& draw, const SetupTriangle& triangle, std::int32_t x,
                            std::int32_t y, TracedFragment& out) {
    const Barycentrics place = barycentrics(draw.mesh(), triangle, x, y);
    const auto fragment = std::make_shared<TwoPackets>(draw.shading, draw.mesh(), triangle, x, y);
    LonePacket& packet = fragment->packet;
    out.barycentrics = place.weight;
    out.one_over_w = number(packet.one_over_w(), place.one_over_w);
    InputTracer tracer(draw.shading, packet, fragment->exact);
    tracer.run(out);
    FragmentInputs inputs = tracer.registers();
    inputs.fetch = fetch_codes({draw.shading, fragment});
    inputs.fetch_exactly = fetch_reals({draw.shading, fragment});
    return inputs;
}

}  // namespace burnish
