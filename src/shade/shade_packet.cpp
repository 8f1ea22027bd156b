#include <algorithm>

#include "shade/shading.hpp"

namespace burnish {

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
        void operator()(const LevelAddressCtx& c) const { k.level_address(p, c); }
        void operator()(const FetchHiloCtx& c) const { k.fetch_hilo(p, c); }
        void operator()(const FetchWordsCtx& c) const { k.fetch_words(p, c); }
        void operator()(const FetchQuartetCtx& c) const { k.fetch_quartet(p, c); }
        void operator()(const LookUpTableCtx& c) const { k.look_up_table(p, c); }
        void operator()(const BlendLevelsCtx& c) const { k.blend_levels(p, c); }
        void operator()(const HiloCtx& c) const { k.hilo(p, c); }
    };
    std::visit(FeedInput{kernels, runs, packet, numbers == NumberModel::nine_bit}, op);
}

void run_program(const LightShading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                 Packet& packet) {
    const BoundProgram& program = shading.program;
    std::size_t done = 0;
    for (const StageSampling& fetch : shading.stage_fetches) {
        run_portions(program, kernels, packet, done, fetch.before);
        done = fetch.before;
        for (const InputOp& op : fetch.ops) feed_input(op, program.numbers, kernels, runs, packet);
    }
    run_portions(program, kernels, packet, done, program.portions.size());
    run_final(program, kernels, packet);
}

namespace {

void run_pass(const EarlierPass& pass, const KernelTable& kernels, const AttributesCtx& runs,
              Packet& packet) {
    load_constants(pass.program, packet);
    for (const InputOp& op : pass.inputs) {
        feed_input(op, pass.program.numbers, kernels, runs, packet);
    }
    run_portions(pass.program, kernels, packet, 0, pass.program.portions.size());
    run_final(pass.program, kernels, packet);
    for (int c = 0; c < 4; ++c) {
        const int from = pass.program.result[static_cast<std::size_t>(c)];
        std::copy_n(packet.planes + from * kPacketSize, kPacketSize,
                    packet.planes + (pass.frame + c) * kPacketSize);
    }
}

/// Constant planes are in place unless another program ran before.
void run_light(const LightShading& light, bool constants_in_place, const KernelTable& kernels,
               const AttributesCtx& runs, Packet& packet) {
    for (const EarlierPass& pass : light.earlier_passes) run_pass(pass, kernels, runs, packet);
    if (!constants_in_place || !light.earlier_passes.empty()) load_constants(light.program, packet);
    for (const InputOp& op : light.inputs) {
        feed_input(op, light.program.numbers, kernels, runs, packet);
    }
    run_program(light, kernels, runs, packet);
}

}  // namespace

void shade_packet(const Shading& shading, const KernelTable& kernels, const AttributesCtx& runs,
                  Packet& packet) {
    kernels.attributes(packet, runs);
    if (shading.further_lights.empty()) {
        return run_light(shading, true, kernels, runs, packet);
    }
    const bool nine_bit = shading.program.numbers == NumberModel::nine_bit;
    const auto add = nine_bit ? kernels.portion_nine_bit : kernels.portion_wide;
    std::fill_n(packet.planes + shading.zero_plane * kPacketSize, kPacketSize, std::int16_t{0});
    for (const FurtherLight& light : shading.further_lights) {
        run_light(light, false, kernels, runs, packet);
        add(packet, light.add);
    }
    run_light(shading, false, kernels, runs, packet);
    add(packet, shading.add_first);
}

}  // namespace burnish
