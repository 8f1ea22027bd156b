#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>

#include "shade/shading.hpp"

namespace burnish {

namespace {

/// All codes of a register plane in one.
int codes_of(const Packet& packet, int plane) {
    const std::int16_t* const codes = packet.planes + plane * kPacketSize;
    const int count = packet.count;
    std::uint16_t any = 0;
    for (int i = 0; i < count; ++i)
        any = static_cast<std::uint16_t>(any | static_cast<std::uint16_t>(codes[i]));
    return any;
}

/// The same addresses from the plain stage, where all of them are in one flat level.
std::optional<AddressCtx> in_base_level(const LevelAddressCtx& c, const Packet& packet) {
    const bool flat = c.face < 0 && c.r < 0;
    if (!flat || c.choice == LevelChoice::ceiling) return {};
    if (c.lambda >= 0 && codes_of(packet, c.lambda) != 0) return {};
    return AddressCtx{
        c.u,
        c.v,
        c.q,
        c.levels[0].width,
        c.levels[0].height,
        c.pitch,
        c.mode_s,
        c.mode_t,
        c.mag_linear,
        c.rectangle,
        static_cast<std::uint8_t>(std::countr_zero(static_cast<unsigned>(c.texel_bytes)))};
}

}  // namespace

void feed_input(const InputOp& op, NumberModel numbers, const KernelTable& kernels,
                const AttributesCtx& runs, Packet& packet) {
    struct FeedInput {
        const KernelTable& k;
        const AttributesCtx& runs;
        Packet& p;
        bool nine_bit;
        void operator()(const ClearCtx& c) const {
            std::fill_n(p.planes + c.plane * kPacketSize, kPacketSize, std::int16_t{0});
        }
        void operator()(const CopyCtx& c) const {
            std::copy_n(p.planes + c.from * kPacketSize, kPacketSize,
                        p.planes + c.to * kPacketSize);
        }
        void operator()(const FillCtx& c) const {
            std::fill_n(p.attributes + c.attribute * kAttributeStride, kPacketSize, c.value);
        }
        void operator()(const LightingCtx& c) const { k.lighting(p, c); }
        void operator()(const AddressCtx& c) const { k.address(p, c); }
        void operator()(const EncodeCtx& c) const {
            (nine_bit ? k.encode_nine_bit : k.encode_wide)(p, c);
        }
        void operator()(const FetchCtx& c) const {
            (nine_bit ? k.fetch_nine_bit : k.fetch_wide)(p, c);
        }
        void operator()(const DecodeCtx& c) const {
            (nine_bit ? k.decode_nine_bit : k.decode_wide)(p, c);
        }
        void operator()(const AffineCtx& c) const { k.affine(p, c); }
        void operator()(const DotCtx& c) const { k.dot_product(p, c); }
        void operator()(const HemisphereCtx& c) const { k.hemisphere(p, c); }
        void operator()(const OffsetCtx& c) const { k.offset(p, c); }
        void operator()(const ReflectCtx& c) const { k.reflect(p, c); }
        void operator()(const QuotientCtx& c) const { k.quotient(p, c); }
        void operator()(const AngleCtx& c) const { k.angle(p, c); }
        void operator()(const CullCtx& c) const { k.cull(p, c); }
        void operator()(const MagnitudeCtx& c) const {
            (nine_bit ? k.dim_nine_bit : k.dim_wide)(p, c);
        }
        void operator()(const CubeFaceCtx& c) const { k.cube_face(p, c); }
        void operator()(const PlaneFootprintCtx& c) const {
            k.plane_footprint(p, {c.footprint, runs});
        }
        void operator()(const QuadFootprintCtx& c) const { k.quad_footprint(p, c); }
        void operator()(const LevelOfDetailCtx& c) const { k.level_of_detail(p, c); }
        void operator()(const LevelAddressCtx& c) const {
            if (const auto plain = in_base_level(c, p)) return k.address(p, *plain);
            k.level_address(p, c);
        }
        void operator()(const FetchHiloCtx& c) const { k.fetch_hilo(p, c); }
        void operator()(const FetchWordsCtx& c) const { k.fetch_words(p, c); }
        void operator()(const FetchQuartetCtx& c) const { k.fetch_quartet(p, c); }
        void operator()(const PrefetchQuartetCtx& c) const { k.prefetch_quartet(p, c); }
        void operator()(const LookUpTableCtx& c) const { k.look_up_table(p, c); }
        void operator()(const AverageTableCtx& c) const { k.average_table(p, c); }
        void operator()(const BlendLevelsCtx& c) const { k.blend_levels(p, c); }
        void operator()(const HiloCtx& c) const { k.hilo(p, c); }
        void operator()(const BlendedCtx& /*c*/) const {}  // feed_inputs() may leave some out
        void operator()(const ProbeExtentCtx& c) const {
            ProbeExtentCtx of_packet = c;
            of_packet.runs = runs;
            k.probe_extent(p, of_packet);
        }
        void operator()(const ProbedCtx& /*c*/) const {}  // feed_inputs() repeats some
    };
    std::visit(FeedInput{kernels, runs, packet, numbers == NumberModel::nine_bit}, op);
}

namespace {

/// The most probes that a fragment of the packet has. Bits of positive floats are in their order,
/// and the largest of integers is quickly found.
int most_probes(const Packet& packet, int attribute) {
    const float* const probes = packet.attributes + attribute * kAttributeStride;
    std::int32_t most = 0;
    for (int i = 0; i < packet.count; ++i)
        most = std::max(most, std::bit_cast<std::int32_t>(probes[i]));
    return static_cast<int>(std::bit_cast<float>(most));
}

/// `ops` once for every probe.
void feed_probes(const ProbedCtx& probed, std::span<const InputOp> ops, NumberModel numbers,
                 const KernelTable& kernels, const AttributesCtx& runs, Packet& packet) {
    const int probes = most_probes(packet, probed.point.probes);
    ProbePointCtx point = probed.point;
    ProbeSumCtx sum = probed.sum;
    for (int k = 0; k < probes; ++k) {
        point.probe = sum.probe = k;
        kernels.probe_point(packet, point);
        feed_inputs(ops, numbers, kernels, runs, packet);
        if (probes > 1) kernels.probe_sum(packet, sum);
    }
    if (probes > 1) kernels.probe_mean(packet, sum);
}

}  // namespace

void feed_inputs(std::span<const InputOp> ops, NumberModel numbers, const KernelTable& kernels,
                 const AttributesCtx& runs, Packet& packet) {
    int known = -1, weights = 0;  // of register plane `known`
    for (std::size_t i = 0; i < ops.size(); ++i) {
        if (const auto* probed = std::get_if<ProbedCtx>(&ops[i])) {
            const auto count = static_cast<std::size_t>(probed->count);
            feed_probes(*probed, ops.subspan(i + 1, count), numbers, kernels, runs, packet);
            i += count;
            continue;
        }
        const auto* blended = std::get_if<BlendedCtx>(&ops[i]);
        if (blended == nullptr) {
            if (std::holds_alternative<LevelOfDetailCtx>(ops[i])) known = -1;
            feed_input(ops[i], numbers, kernels, runs, packet);
            continue;
        }
        if (blended->weight != known) weights = codes_of(packet, known = blended->weight);
        if ((weights & 255) == 0) i += static_cast<std::size_t>(blended->count);
    }
}

void run_program(const LightShading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                 Packet& packet) {
    const BoundProgram& program = shading.program;
    std::size_t done = 0;
    for (const StageSampling& fetch : shading.stage_fetches) {
        run_portions(program, kernels, packet, done, fetch.before);
        done = fetch.before;
        feed_inputs(fetch.ops, program.numbers, kernels, runs, packet);
    }
    run_portions(program, kernels, packet, done, program.portions.size());
    run_final(program, kernels, packet);
}

namespace {

void run_pass(const EarlierPass& pass, const KernelTable& kernels, const AttributesCtx& runs,
              Packet& packet) {
    load_constants(pass.program, packet);
    feed_inputs(pass.inputs, pass.program.numbers, kernels, runs, packet);
    run_portions(pass.program, kernels, packet, 0, pass.program.portions.size());
    run_final(pass.program, kernels, packet);
    for (int c = 0; c < 4; ++c) {
        const int from = pass.program.result[static_cast<std::size_t>(c)];
        std::copy_n(packet.planes + from * kPacketSize, kPacketSize,
                    packet.planes + (pass.frame + c) * kPacketSize);
    }
}

/// Constant planes are in place unless another program ran before.
void run_light(const LightShading& light, std::span<const InputOp> inputs, bool constants_in_place,
               const KernelTable& kernels, const AttributesCtx& runs, Packet& packet) {
    for (const EarlierPass& pass : light.earlier_passes) run_pass(pass, kernels, runs, packet);
    if (!constants_in_place || !light.earlier_passes.empty()) load_constants(light.program, packet);
    feed_inputs(inputs, light.program.numbers, kernels, runs, packet);
    run_program(light, kernels, runs, packet);
}

/// The input operations of the only light: as packets run them, or those of a corner, without what
/// the corner before it has brought already.
std::span<const InputOp> inputs_of_light(const Shading& shading, bool again) {
    if (!shading.corners) return shading.packet_inputs;
    const bool alone = again && shading.earlier_passes.empty();
    return std::span(shading.inputs).subspan(alone ? shading.fixed_inputs : 0);
}

/// The sum of all lights, once more after `again` for other coordinates of texels.
void run_lights(const Shading& shading, bool again, const KernelTable& kernels,
                const AttributesCtx& runs, Packet& packet) {
    if (shading.further_lights.empty()) {
        return run_light(shading, inputs_of_light(shading, again), true, kernels, runs, packet);
    }
    const bool nine_bit = shading.program.numbers == NumberModel::nine_bit;
    const auto add = nine_bit ? kernels.portion_nine_bit : kernels.portion_wide;
    std::fill_n(packet.planes + shading.zero_plane * kPacketSize, kPacketSize, std::int16_t{0});
    for (const FurtherLight& light : shading.further_lights) {
        run_light(light, light.inputs, false, kernels, runs, packet);
        add(packet, light.add);
    }
    run_light(shading, shading.inputs, false, kernels, runs, packet);
    add(packet, shading.add_first);
}

/// The same at the four corners in the level that `corner` chooses, and the filter over them.
void run_corners(const Shading& shading, TexelCornerCtx corner, const FilterCtx& filter, bool again,
                 const KernelTable& kernels, const AttributesCtx& runs, Packet& packet) {
    for (int k = 0; k < FilterCtx::kCorners; ++k) {
        corner.right = static_cast<std::uint8_t>(k & 1);
        corner.below = static_cast<std::uint8_t>(k >> 1);
        kernels.texel_corner(packet, corner);
        run_lights(shading, again || k > 0, kernels, runs, packet);
        for (int c = 0; c < 4; ++c) {
            const int from = shading.corners->colors[static_cast<std::size_t>(c)];
            std::copy_n(packet.planes + from * kPacketSize, kPacketSize,
                        packet.planes + (filter.corners + 4 * k + c) * kPacketSize);
        }
    }
    const bool nine_bit = shading.program.numbers == NumberModel::nine_bit;
    (nine_bit ? kernels.filter_nine_bit : kernels.filter_wide)(packet, filter);
}

void filter_after(const Shading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                  Packet& packet) {
    const CornerShading& corners = *shading.corners;
    feed_inputs(corners.level, shading.program.numbers, kernels, runs, packet);
    run_corners(shading, corners.corner, corners.filter, false, kernels, runs, packet);
    if (!corners.blends_levels() || (codes_of(packet, corners.corner.lambda) & 255) == 0) return;
    TexelCornerCtx above = corners.corner;
    above.choice = LevelChoice::ceiling;
    FilterCtx filter = corners.filter;
    filter.out = corners.blend.b;
    run_corners(shading, above, filter, true, kernels, runs, packet);
    kernels.blend_levels(packet, corners.blend);
}

}  // namespace

void shade_packet(const Shading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                  Packet& packet) {
    kernels.attributes(packet, runs);
    if (shading.corners) return filter_after(shading, kernels, runs, packet);
    run_lights(shading, false, kernels, runs, packet);
}

}  // namespace burnish
