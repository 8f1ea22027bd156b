#include "shade/table_look_up.hpp"

#include <numeric>

#include "core/aligned.hpp"
#include "core/cpu.hpp"

namespace burnish {

SpanToEdges to_edges(TexelSpan span, int size) {
    if (span == TexelSpan::edges) return {1.0F, 0.0F, 1.0F};
    const auto n = static_cast<float>(size);
    const bool is_signed = span == TexelSpan::signed_centers;
    const float scale = is_signed ? 0.5F * (n - 1.0F) : n - 1.0F;
    return {scale, is_signed ? 0.5F * n : 0.5F, n};
}

LookUpTableCtx table_look_up(const Texture& table, int s, int t) {
    const auto axis = [](TexelSpan span, int size, int plane) {
        const SpanToEdges edges = to_edges(span, size);
        return LookUpTableCtx::Axis{plane, size, edges.scale, edges.offset, edges.divisor};
    };
    const Sampler& sampler = table.sampler();
    const bool has_two = table.target() == TextureTarget::two_d;
    return {table.texels(),
            axis(sampler.span_s, table.width(), s),
            axis(sampler.span_t, table.height(), has_two ? t : -1),
            table.pitch(),
            {-1, -1, -1, -1},
            table.codes()};
}

std::vector<std::int16_t> table_codes(const Texture& table) {
    constexpr int kCodes = 65536;
    AlignedVector<std::int16_t> planes(std::size_t{2} * kPacketSize);
    Packet packet{};
    packet.count = kPacketSize;
    packet.planes = planes.data();
    LookUpTableCtx ctx = table_look_up(table, 0, -1);
    ctx.out[0] = 1;
    const auto look_up = available_tables().front()->look_up_table;  // all have the same bits
    std::vector<std::int16_t> codes;
    codes.reserve(kCodes);
    for (int first = 0; first < kCodes; first += kPacketSize) {
        std::iota(packet.planes, packet.planes + kPacketSize, static_cast<std::int16_t>(first));
        look_up(packet, ctx);
        codes.insert(codes.end(), packet.planes + kPacketSize, packet.planes + 2 * kPacketSize);
    }
    return codes;
}

}  // namespace burnish
