#include "bench/kernels/stages.hpp"

namespace burnish::bench {

void add_texture_shader() {
    PacketMemory packet;
    Random random(9);
    for (int i = 0; i < kPacketSize; ++i) {
        for (int k = 0; k < 8; ++k) packet.attribute(k)[i] = random.real(-1.0F, 1.0F);
        packet.attribute(8)[i] = random.real(0.5F, 2.0F);
        for (int k = 0; k < 8; ++k)
            packet.plane(k)[i] = static_cast<std::int16_t>(random.below(256));
    }
    const Written one{.attributes = {20}};
    add_packet_stage("decode_nine_bit", &KernelTable::decode_nine_bit, packet,
                     DecodeCtx{3, 20, Reading::unsigned_texel}, one);
    add_packet_stage("decode_wide/expand", &KernelTable::decode_wide, packet,
                     DecodeCtx{3, 20, Reading::expanded}, one);
    add_packet_stage("affine", &KernelTable::affine, packet, AffineCtx{0, 20, 2.0F, -1.0F, 1.0F},
                     one);
    add_packet_stage("dot_product", &KernelTable::dot_product, packet,
                     DotCtx{{0, 1, 2}, {3, 4, 5}, 20}, one);
    add_packet_stage("hemisphere", &KernelTable::hemisphere, packet, HemisphereCtx{0, 1, 20}, one);
    add_packet_stage("offset", &KernelTable::offset, packet,
                     OffsetCtx{0, 1, -1, 2, 3, {0.1F, 0.2F, 0.3F, 0.4F}, 20},
                     Written{.attributes = {20, 21}});
    add_packet_stage("offset/over_q", &KernelTable::offset, packet,
                     OffsetCtx{0, 1, 8, 2, 3, {0.1F, 0.2F, 0.3F, 0.4F}, 20},
                     Written{.attributes = {20, 21}});
    add_packet_stage("reflect", &KernelTable::reflect, packet, ReflectCtx{{0, 1, 2}, {3, 4, 5}, 20},
                     Written{.attributes = {20, 21, 22}});
    add_packet_stage("quotient", &KernelTable::quotient, packet, QuotientCtx{0, 8, 20}, one);
    add_packet_stage("angle", &KernelTable::angle, packet, AngleCtx{0, 1, 20}, one);
    add_packet_stage("cull", &KernelTable::cull, packet,
                     CullCtx{{0, 1, 2, 3}, {0, 1, 0, 1}, -1, 20}, one);
    const MagnitudeCtx dim{4, 0, 8, 0.75F, 0.5F, 1};
    const Written dimmed{.planes = {8, 9, 10, 11}};
    add_packet_stage("dim_nine_bit", &KernelTable::dim_nine_bit, packet, dim, dimmed);
    add_packet_stage("dim_wide", &KernelTable::dim_wide, packet, dim, dimmed);
}

}  // namespace burnish::bench
