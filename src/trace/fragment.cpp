#include "trace/fragment.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "shade/attributes.hpp"
#include "trace/exact_inputs.hpp"
#include "trace/interpolants.hpp"
#include "trace/texel_bytes.hpp"
#include "trace/unit_numbers.hpp"

namespace burnish {

namespace {

/// The scalar kernels on a packet with the traced fragment and, where operations look at
/// neighbours, the three others of its quad. The packet's first fragment lies at the tile's first
/// pixel.
class LonePacket {
  public:
    LonePacket(const Shading& shading, const ScreenMesh& mesh, const SetupTriangle& triangle,
               std::int32_t x, std::int32_t y)
        : m_attributes(static_cast<std::size_t>(kMaxAttributes) * kAttributeStride),
          m_planes(static_cast<std::size_t>(shading.program.plane_count) * kPacketSize) {
        PlaneInputs scratch;
        const SetupTriangle* const only[1] = {&triangle};
        m_equations.resize(equation_rows(shading) * kAttributeStride);
        attribute_planes(shading, mesh, only, table_reference(), scratch, m_equations.data());
        const int column = shading.quads ? x % 2 : 0, row = shading.quads ? y % 2 : 0;
        m_at = 2 * row + column;
        m_packet.count = shading.quads ? 4 : 1;
        m_run = {0, m_packet.count, x - column - triangle.reference_x,
                 y - row - triangle.reference_y};
        // Divided by the constant 1, the plane of 1/w shows itself.
        AlignedVector<float> by_one(std::size_t{6} * kAttributeStride);
        by_one[0] = 1.0F;
        std::copy_n(m_equations.begin(), 3 * kAttributeStride,
                    by_one.begin() + 3 * kAttributeStride);
        table_reference().attributes(m_packet, {&m_run, 1, 1, by_one.data()});
        m_one_over_w = attribute(0);
        m_runs = {&m_run, 1, shading.interpolated(), m_equations.data()};
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
        return m_attributes[static_cast<std::size_t>(k * kAttributeStride + m_at)];
    }
    [[nodiscard]] int plane(int k) const {
        return m_planes[static_cast<std::size_t>(k * kPacketSize + m_at)];
    }
    /// The longer step of plane k, to the fragment's neighbour in its row or in its column.
    [[nodiscard]] int step(int k) const {
        const auto change = [&](int neighbour) {
            const auto at = static_cast<std::size_t>(k * kPacketSize + neighbour);
            return std::abs(m_planes[at] - plane(k));
        };
        return std::max(change(m_at ^ 1), change(m_at ^ 2));
    }
    [[nodiscard]] float one_over_w() const { return m_one_over_w; }
    [[nodiscard]] std::int32_t texel() const { return m_texel[m_at]; }
    [[nodiscard]] int weight_x() const { return m_weight_x[m_at]; }
    [[nodiscard]] int weight_y() const { return m_weight_y[m_at]; }

  private:
    AlignedVector<float> m_attributes;
    AlignedVector<std::int16_t> m_planes;
    AlignedVector<float> m_equations;  ///< AttributesCtx
    Run m_run{};
    AttributesCtx m_runs{};
    int m_at = 0;  ///< the traced fragment
    std::uint16_t m_pixel[4] = {0, 1, kBlockSize, kBlockSize + 1};
    std::int32_t m_texel[4] = {};
    std::int16_t m_weight_x[4] = {}, m_weight_y[4] = {};
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

/// An operation in exact numbers. How much of a texture a quad covers is the machine's number: of
/// its other fragments nothing exact is known.
void feed_exactly(const InputOp& op, const LonePacket& packet, ExactInputs& exact) {
    if (const auto* quad = std::get_if<QuadFootprintCtx>(&op)) {
        const int out = quad->footprint.out;
        exact.set_attribute(out, static_cast<double>(packet.attribute(out)));
    } else {
        exact.feed(op);
    }
}

/// Runs the input operations of a shading and notes what they give.
class InputTracer {
  public:
    InputTracer(const Shading& shading, LonePacket& packet, ExactInputs& exact)
        : m_shading(shading), m_packet(packet), m_exact(exact) {}

    void run(TracedFragment& out) {
        for (std::size_t i = 0; i < m_shading.inputs.size(); ++i) {
            const InputOp& op = m_shading.inputs[i];
            if (const auto* probed = std::get_if<ProbedCtx>(&op)) {
                const auto count = static_cast<std::size_t>(probed->count);
                run_probes(*probed, std::span(m_shading.inputs).subspan(i + 1, count), out);
                i += count;
                continue;
            }
            feed_machine(op);
            feed_exactly(op, m_packet, m_exact);
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
        result.exact = m_exact.registers();
        for (auto& filled : result.filled.values) filled.fill(true);
        const BoundProgram& program = m_shading.program;
        for (const Register reg : {Register::col0, Register::col1}) {
            for (std::size_t c = 0; c < 4; ++c) take(reg, c, result);
        }
        for (int unit = 0; unit < 16; ++unit) {
            if ((m_shading.unit_states.black >> unit & 1) != 0) continue;
            if ((m_shading.unit_states.enabled >> unit & 1) == 0) {
                result.codes[tex(unit)][3] = code_of_one(program.numbers);
                continue;
            }
            for (std::size_t c = 0; c < 4; ++c) take(tex(unit), c, result);
        }
        result.filled[Register::spare0][3] = result.filled[Register::tex0][3];
        return result;
    }

  private:
    void feed_machine(const InputOp& op) {
        feed_input(op, m_shading.program.numbers, table_reference(), m_packet.runs(),
                   m_packet.packet());
    }

    /// `ops` for every probe of the fragment; neighbours of its quad need no more.
    void run_probes(const ProbedCtx& probed, std::span<const InputOp> ops, TracedFragment& out) {
        const KernelTable& kernels = table_reference();
        m_exact.feed_probes(probed, ops);
        const int probes = static_cast<int>(m_packet.attribute(probed.point.probes));
        ProbePointCtx point = probed.point;
        ProbeSumCtx sum = probed.sum;
        for (m_probe = 0; m_probe < probes; ++m_probe) {
            point.probe = sum.probe = m_probe;
            kernels.probe_point(m_packet.packet(), point);
            for (const InputOp& op : ops) {
                feed_machine(op);
                note(op, out);
            }
            kernels.probe_sum(m_packet.packet(), sum);
        }
        m_probe = 0;
        kernels.probe_mean(m_packet.packet(), sum);
        for (int c = 0; c < sum.channels; ++c)
            if (const std::optional<int> unit = unit_of_plane(sum.plane[c]))
                set_probes(probed.point, sum.plane[c], fetch_of(*unit, out));
    }

    /// Of a fetch whose probes have all been looked at: where the pixel is, how they lie, and the
    /// mean.
    void set_probes(const ProbePointCtx& point, int plane, TracedFetch& fetch) const {
        const auto coordinate = [&](int k) {
            const float q = point.q < 0 ? 1.0F : m_packet.attribute(point.q);
            const double exact_q = point.q < 0 ? 1.0 : m_exact.attribute(point.q);
            return number(m_packet.attribute(k) / q, m_exact.attribute(k) / exact_q);
        };
        const auto value = [&](int k) {
            return number(m_packet.attribute(k), m_exact.attribute(k));
        };
        fetch.u = coordinate(point.u);
        fetch.v = coordinate(point.v);
        fetch.probes = value(point.probes);
        fetch.apart = {value(point.step), value(point.step + 1)};
        set_color(plane, fetch);
    }

    static TracedFetch& fetch_of(int unit, TracedFragment& out) {
        return *std::find_if(out.fetches.begin(), out.fetches.end(),
                             [&](const TracedFetch& f) { return f.unit == unit; });
    }

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
        } else if (const auto* quartet = std::get_if<FetchQuartetCtx>(&op)) {
            for (int k = 0; k < FetchQuartetCtx::kTextures; ++k) {
                if (quartet->plane[k] < 0) continue;
                const std::uint8_t* const texels =
                    quartet->texels + FetchQuartetCtx::kNextTexture * k;
                add_fetch(texture_at(m_shading, texels), quartet->plane[k], out);
            }
        } else if (const auto* blend = std::get_if<BlendLevelsCtx>(&op)) {
            add_blend(*blend, out);
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

    void add_fetch(const Texture& texture, int plane, TracedFragment& out) {
        const TracedTaps taps = taps_of(texture);
        const std::optional<int> unit = unit_of_plane(plane);
        if (!unit) {  // of a level or slice that is to be blended with others
            m_scratch[plane] = {taps};
            return;
        }
        if (m_probe > 0) {
            fetch_of(*unit, out).further.push_back(taps);
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
        std::vector<TracedTaps>& to = unit ? fetch_of(*unit, out).further : m_scratch[ctx.out];
        const std::vector<TracedTaps>& from = m_scratch[ctx.b];
        to.insert(to.end(), from.begin(), from.end());
        if (unit) set_color(ctx.out, fetch_of(*unit, out));
    }

    [[nodiscard]] TracedTaps taps_of(const Texture& texture) const {
        TracedTaps taps;
        const int lod = m_level.lambda < 0 ? 0 : m_packet.plane(m_level.lambda);
        taps.level =
            m_level.level_count == 0 ? 0 : chosen_level(m_level.choice, m_level.level_count, lod);
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
    int m_probe = 0;                                   ///< which one is looked at
};

/// Serves the fetches between stages in their order.
class StageFetches {
  public:
    StageFetches(const Draw& draw, LonePacket& packet, ExactInputs exact)
        : m_draw(&draw), m_exact(std::move(exact)) {
        run_program(packet);
    }

    /// The machine's codes: what the scalar kernels brought, since neighbours count, too.
    [[nodiscard]] FetchCodes codes() const {
        return [fetches = *this, next = std::size_t{0}](
                   const StageFetch& fetch, const std::array<float, 3>& /*at*/) mutable {
            if (!fetches.has_texture(fetch))
                return Codes{0, 0, 0, code_of_one(fetches.program().numbers)};
            return fetches.m_codes.at(next++);
        };
    }

    /// The texels of exact coordinates; the level of detail is the machine's.
    [[nodiscard]] FetchReals exact() const {
        return [fetches = *this, next = std::size_t{0}](const StageFetch& fetch,
                                                        const std::array<double, 3>& at) mutable {
            if (!fetches.has_texture(fetch)) return Reals{0.0, 0.0, 0.0, 1.0};
            const std::size_t number = next++;
            return fetches.m_exact.fetch_between_stages(number, at,
                                                        fetches.m_footprints.at(number));
        };
    }

  private:
    [[nodiscard]] const BoundProgram& program() const { return m_draw->shading.program; }
    [[nodiscard]] bool has_texture(const StageFetch& fetch) const {
        const int unit = static_cast<int>(fetch.destination) - static_cast<int>(Register::tex0);
        return (m_draw->shading.unit_states.textured >> unit & 1) != 0;
    }

    /// Portion by portion, as the renderer does.
    void run_program(LonePacket& lone) {
        const KernelTable& kernels = table_reference();
        Packet& packet = lone.packet();
        load_constants(program(), packet);
        std::size_t done = 0;
        for (std::size_t i = 0; i < program().fetches.size(); ++i) {
            const StageSampling& fetch = m_draw->shading.stage_fetches[i];
            run_portions(program(), kernels, packet, done, fetch.before);
            done = fetch.before;
            double footprint = 0.0;
            for (const InputOp& op : fetch.ops) {
                feed_input(op, program().numbers, kernels, lone.runs(), packet);
                if (const auto* quad = std::get_if<QuadFootprintCtx>(&op))
                    footprint = static_cast<double>(lone.attribute(quad->footprint.out));
            }
            Codes codes{};
            for (std::size_t c = 0; c < 4; ++c)
                codes[c] = lone.plane(program().fetches[i].out + static_cast<int>(c));
            if (const auto* table = std::get_if<LookUpTableCtx>(&fetch.ops.back()))
                codes.fill(lone.plane(any_output(table->out)));
            if (const auto* sums = std::get_if<AverageTableCtx>(&fetch.ops.back())) {
                codes.fill(lone.plane(any_output(sums->out)));
                footprint = lone.step(sums->s.plane) * static_cast<double>(sums->reach);
            }
            m_codes.push_back(codes);
            m_footprints.push_back(footprint);
        }
    }

    const Draw* m_draw;
    ExactInputs m_exact;
    std::vector<Codes> m_codes;
    std::vector<double> m_footprints;
};

/// What moves coordinates to a corner, on both kinds of numbers.
TracedCorner stand_at(const Shading& shading, const CornerChoice& at, LonePacket& packet,
                      ExactInputs& exact) {
    const CornerShading& corners = *shading.corners;
    for (const InputOp& op : corners.level) {
        feed_input(op, shading.program.numbers, table_reference(), packet.runs(), packet.packet());
        feed_exactly(op, packet, exact);
    }
    TexelCornerCtx corner = corners.corner;
    corner.right = at.right ? 1 : 0;
    corner.below = at.below ? 1 : 0;
    if (at.above) corner.choice = LevelChoice::ceiling;
    table_reference().texel_corner(packet.packet(), corner);
    exact.stand_at(corner);
    TracedCorner traced;
    traced.right = at.right;
    traced.below = at.below;
    const auto weight = [&](std::size_t axis) {
        return TracedNumber{packet.plane(corner.weight + static_cast<int>(axis)) / 256.0,
                            exact.corner_weights().at(axis)};
    };
    traced.weight_x = weight(0);
    traced.weight_y = weight(1);
    traced.u = number(packet.attribute(corner.to), exact.attribute(corner.to));
    traced.v = number(packet.attribute(corner.to + 1), exact.attribute(corner.to + 1));
    if (corner.lambda >= 0) {
        const double lod = exact.plane(corner.lambda);
        const int code = packet.plane(corner.lambda);
        traced.level = chosen_level(corner.choice, corner.level_count, code);
        if (corners.blends_levels())
            traced.level_weight = {(code & 255) / 256.0, lod - std::floor(lod)};
    }
    return traced;
}

}  // namespace

FragmentInputs trace_inputs(const Draw& draw, const SetupTriangle& triangle, std::int32_t x,
                            std::int32_t y, const CornerChoice* at, TracedFragment& out) {
    const Barycentrics place = barycentrics(draw.mesh(), triangle, x, y);
    LonePacket packet(draw.shading, draw.mesh(), triangle, x, y);
    ExactInputs exact(draw.shading, draw.mesh(), triangle, x, y);
    out.barycentrics = place.weight;
    out.one_over_w = number(packet.one_over_w(), place.one_over_w);
    if (at != nullptr) out.corner = stand_at(draw.shading, *at, packet, exact);
    InputTracer tracer(draw.shading, packet, exact);
    tracer.run(out);
    FragmentInputs inputs = tracer.registers();
    const StageFetches fetches(draw, packet, std::move(exact));
    inputs.fetch = fetches.codes();
    inputs.fetch_exactly = fetches.exact();
    return inputs;
}

}  // namespace burnish
