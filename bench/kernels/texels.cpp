#include <algorithm>
#include <vector>

#include "bench/kernels/stages.hpp"

namespace burnish::bench {
namespace {

constexpr int kTexture = 256;                         // texels, both ways
constexpr std::int32_t kPitch = 4 * (kTexture + 16);  // bytes

}  // namespace

void add_texels() {
    static std::vector<std::uint8_t> texels;
    Random random(4);
    texels.resize(static_cast<std::size_t>(kPitch * (kTexture + 1)));
    for (std::uint8_t& t : texels) t = static_cast<std::uint8_t>(random.below(256));
    PacketMemory packet;
    // A quarter turn of the texture at one texel per pixel, as four blocks see it.
    for (int i = 0; i < kPacketSize; ++i) {
        const auto x = static_cast<float>(i / 64 * 8 + i % 8);
        const auto y = static_cast<float>(i % 64 / 8);
        packet.attribute(0)[i] = 0.3F + (x * 0.8F - y * 0.6F) / static_cast<float>(kTexture);
        packet.attribute(1)[i] = 0.9F + (x * 0.6F + y * 0.8F) / static_cast<float>(kTexture);
        packet.attribute(2)[i] = 1.0F + 0.001F * x;
    }
    AddressCtx ctx{0, 1, -1, kTexture, kTexture, kPitch, AddressMode::repeat, AddressMode::repeat,
                   1};
    const Written addresses{.addresses = true};
    add_packet_stage("address/repeat", &KernelTable::address, packet, ctx, addresses);
    Packet view = packet.view();
    table_reference().address(view, ctx);
    ctx.q = 2;
    add_packet_stage("address/repeat_over_q", &KernelTable::address, packet, ctx, addresses);
    ctx = {0,
           1,
           -1,
           kTexture,
           kTexture,
           kPitch,
           AddressMode::clamp_to_edge,
           AddressMode::clamp_to_edge,
           1};
    add_packet_stage("address/clamp", &KernelTable::address, packet, ctx, addresses);

    FetchCtx fetch{{}, {}, {}, 1, kPitch};
    for (int k = 0; k < 3; ++k) {
        fetch.texels[k] = texels.data();
        fetch.plane[k] = 4 * k;
    }
    Written fetched{.planes = {0, 1, 2, 3}};
    add_packet_stage("fetch_nine_bit", &KernelTable::fetch_nine_bit, packet, fetch, fetched);
    add_packet_stage("fetch_wide", &KernelTable::fetch_wide, packet, fetch, fetched);
    fetch.count = 3;
    for (int plane = 4; plane < 12; ++plane) fetched.planes.push_back(plane);
    add_packet_stage("fetch_nine_bit/three_maps", &KernelTable::fetch_nine_bit, packet, fetch,
                     fetched);
}

/// What levels, faces, slices and words cost besides the bilinear fetch.
void add_levels() {
    PacketMemory packet;
    Random random(5);
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < kPacketSize; ++i) packet.attribute(k)[i] = random.real(-1.0F, 1.0F);
    for (int i = 0; i < kPacketSize; ++i) {
        packet.attribute(6)[i] = random.real(0.5F, 200.0F);
        packet.plane(5)[i] = static_cast<std::int16_t>(random.below(900));
        packet.texel[static_cast<std::size_t>(i)] = 8 * random.below(256);
        packet.weight_x[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(i % 256);
        packet.weight_y[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(255 - i % 256);
    }
    add_packet_stage("cube_face", &KernelTable::cube_face, packet, CubeFaceCtx{0, 1, 2, 7, 8, 5},
                     {.planes = {5}, .attributes = {7, 8}});
    static Equations equations(3);
    static std::vector<Run> runs;
    for (int r = 0; r < kPacketSize / 16; ++r) {
        equations.set(0, r, {1.0F, 0.001F, 0.002F});
        equations.set(1, r, {0.3F, 0.8F, 0.1F});
        equations.set(2, r, {0.2F, 0.1F, 0.9F});
        equations.set(3, r, {1.0F, 0.0F, 0.0F});
        runs.push_back({16 * r, 16, 100, 200});
    }
    const FootprintCtx footprint{0, 1, -1, -1, 0, {256.0F, 256.0F, 1.0F}, 7};
    add_packet_stage(
        "plane_footprint/runs_of_16", &KernelTable::plane_footprint, packet,
        PlaneFootprintCtx{footprint,
                          {runs.data(), static_cast<int>(runs.size()), 3, equations.data()}},
        {.attributes = {7}});
    add_packet_stage("quad_footprint", &KernelTable::quad_footprint, packet,
                     QuadFootprintCtx{footprint}, {.attributes = {7}});
    add_packet_stage(
        "probe_extent/runs_of_16", &KernelTable::probe_extent, packet,
        ProbeExtentCtx{footprint,
                       {runs.data(), static_cast<int>(runs.size()), 3, equations.data()},
                       8,
                       9,
                       16.0F},
        {.attributes = {7, 8, 9, 10}});
    for (int i = 0; i < kPacketSize; ++i) packet.attribute(8)[i] = static_cast<float>(1 + i % 16);
    add_packet_stage("probe_point", &KernelTable::probe_point, packet,
                     ProbePointCtx{0, 1, -1, 2, 8, 11, 3}, {.attributes = {11, 12}});
    for (int k = 13; k < 17; ++k)
        for (int i = 0; i < kPacketSize; ++i)
            packet.attribute(k)[i] = static_cast<float>(random.below(4096));
    for (int k = 10; k < 14; ++k)
        for (int i = 0; i < kPacketSize; ++i)
            packet.plane(k)[i] = static_cast<std::int16_t>(random.below(256));
    const ProbeSumCtx sum{8, 3, 13, 4, {10, 11, 12, 13}, 0};
    add_packet_stage("probe_sum", &KernelTable::probe_sum, packet, sum,
                     {.attributes = {13, 14, 15, 16}});
    add_packet_stage("probe_mean", &KernelTable::probe_mean, packet, sum,
                     {.planes = {10, 11, 12, 13}});
    add_packet_stage("level_of_detail", &KernelTable::level_of_detail, packet,
                     LevelOfDetailCtx{6, 7, 0, 1024}, {.planes = {7}});
    LevelAddressCtx address{};
    address.v = 1;
    address.q = address.r = address.face = address.slice_weight = -1;
    address.lambda = 5;
    address.choice = LevelChoice::floor;
    address.mag_linear = address.min_linear = 1;
    address.pitch = kPitch;
    address.texel_bytes = 4;
    address.level_count = 9;
    for (int k = 0; k < address.level_count; ++k)
        address.levels[k] = {kTexture >> k, kTexture >> k, 1, 1000 * k};
    add_packet_stage("level_address", &KernelTable::level_address, packet, address,
                     {.addresses = true});
    TexelCornerCtx corner{};
    corner.v = 1;
    corner.q = -1;
    corner.lambda = 5;
    corner.to = 2;
    corner.weight = 6;
    corner.choice = LevelChoice::floor;
    corner.mag_linear = corner.min_linear = 1;
    corner.level_count = address.level_count;
    std::copy_n(address.levels, address.level_count, corner.levels);
    corner.level = 8;
    add_packet_stage("texel_corner", &KernelTable::texel_corner, packet, corner,
                     {.planes = {6, 7, 8}, .attributes = {2, 3}});
    for (int i = 0; i < kPacketSize; ++i) {
        packet.plane(6)[i] = static_cast<std::int16_t>(i % 256);
        packet.plane(7)[i] = static_cast<std::int16_t>(255 - i % 256);
        for (int k = 10; k < 26; ++k)
            packet.plane(k)[i] = static_cast<std::int16_t>(random.below(256));
    }
    add_packet_stage("filter_nine_bit", &KernelTable::filter_nine_bit, packet, FilterCtx{10, 6, 30},
                     {.planes = {30, 31, 32, 33}});
    add_packet_stage("filter_wide", &KernelTable::filter_wide, packet, FilterCtx{10, 6, 30},
                     {.planes = {30, 31, 32, 33}});
    add_packet_stage("blend_levels", &KernelTable::blend_levels, packet,
                     BlendLevelsCtx{10, 14, 20, 4, 5, 0}, {.planes = {20, 21, 22, 23}});
    static const std::vector<std::uint8_t> texels(8192, 77);
    add_packet_stage("fetch_hilo", &KernelTable::fetch_hilo, packet,
                     FetchHiloCtx{texels.data(), 20, 2112}, {.planes = {20, 21}});
    add_packet_stage("fetch_words", &KernelTable::fetch_words, packet,
                     FetchWordsCtx{texels.data(), 20, 2112}, {.planes = {20, 21, 22, 23}});
    for (std::int32_t& texel : packet.texel) texel = 4 * texel % 4096;
    Written fetched;
    for (int plane = 16; plane < 32; ++plane) fetched.planes.push_back(plane);
    add_packet_stage("fetch_quartet", &KernelTable::fetch_quartet, packet,
                     FetchQuartetCtx{texels.data(), {16, 20, 24, 28}, 2112}, fetched);
    add_packet_stage("prefetch_quartet", &KernelTable::prefetch_quartet, packet,
                     PrefetchQuartetCtx{texels.data(), 2112}, {});
    for (const int k : {0, 1})
        for (int i = 0; i < kPacketSize; ++i)
            packet.plane(k)[i] = static_cast<std::int16_t>(random.below(16385));
    LookUpTableCtx table{texels.data(),
                         {0, 60, 59.0F, 0.5F, 60.0F},
                         {1, 32, 31.0F, 0.5F, 32.0F},
                         252,
                         {20, -1, -1, -1}};
    add_packet_stage("look_up_table/of_two", &KernelTable::look_up_table, packet, table,
                     {.planes = {20}});
    table.s = {0, 1024, 1023.0F, 0.5F, 1024.0F};
    table.t.plane = -1;
    add_packet_stage("look_up_table/of_one", &KernelTable::look_up_table, packet, table,
                     {.planes = {20}});
    static const std::vector<std::int16_t> codes(65536, 13139);  // of two bytes 77
    LookUpTableCtx whole = table;
    whole.codes = codes.data();
    add_packet_stage("look_up_table/of_codes", &KernelTable::look_up_table, packet, whole,
                     {.planes = {20}});
    static const std::vector<std::uint8_t> summed(33 * 520, 3);
    AverageTableCtx sums{summed.data(), table.s, table.t, 0x1p-15F,
                         0.0F,          8.0F,    520,     {20, -1, -1, -1}};
    add_packet_stage("average_table/of_one", &KernelTable::average_table, packet, sums,
                     {.planes = {20}});
    sums.s = {0, 60, 59.0F, 0.5F, 60.0F};
    sums.t = {1, 32, 31.0F, 0.5F, 32.0F};
    sums.pitch = 520;
    add_packet_stage("average_table/of_two", &KernelTable::average_table, packet, sums,
                     {.planes = {20}});
    add_packet_stage("hilo", &KernelTable::hilo, packet, HiloCtx{5, 7, 0}, {.attributes = {7, 8}});
}

}  // namespace burnish::bench
