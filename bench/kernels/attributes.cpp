#include <array>
#include <string>
#include <vector>

#include "bench/kernels/stages.hpp"

namespace burnish::bench {
namespace {

/// The triangles between the vertices of a grid, as tiny ones of a mesh are.
struct GridTriangles {
    static constexpr int kSide = 12, kAttributes = 6;  // uv, a half vector and a cosine
    static constexpr int kStride = 8;
    std::vector<HomogeneousVertex> homogeneous;
    std::vector<float> rows = std::vector<float>(kSide * kSide * kStride + 3);
    std::vector<PlaneTriangle> triangles;

    GridTriangles() {
        Random random(21);
        for (float& x : rows) x = random.unit();
        for (int v = 0; v < kSide * kSide; ++v) {
            const float w = random.real(3.0F, 4.0F);
            homogeneous.push_back({100.0F * w, 100.0F * w, 0.5F * w, w});
        }
        for (int y = 0; y + 1 < kSide; ++y) {
            for (int x = 0; x + 1 < kSide; ++x) {
                const auto v = static_cast<std::uint32_t>(y * kSide + x);
                const int left = 1000 * x, top = 900 * y;
                triangles.push_back({{left, left + 1000, left},
                                     {top, top, top + 900},
                                     {v, v + 1, v + kSide},
                                     4 * x,
                                     3 * y,
                                     0});
            }
        }
    }
    void make(const KernelTable& table, int count, Equations& out) const {
        table.attribute_planes({triangles.data(), count, homogeneous.data(), rows.data(), kStride,
                                kAttributes, out.rows.data()});
    }
};

}  // namespace

void add_attributes() {
    constexpr int kAttributes = 14;  // tangent frame, position, texture coordinates
    static Equations equations(kAttributes);
    static std::array<std::vector<Run>, 4> runs;
    Random random(2);
    for (int e = 0; e <= kAttributes; ++e)
        for (int r = 0; r < kPacketSize; ++r)
            equations.set(
                e, r,
                {random.real(0.5F, 1.0F), random.real(0.0F, 0.01F), random.real(0.0F, 0.01F)});
    Written written;
    for (int k = 0; k < kAttributes; ++k) written.attributes.push_back(k);
    const std::array lengths{1, 4, 16, 64};
    for (std::size_t v = 0; v < lengths.size(); ++v) {
        const int length = lengths[v];
        for (int first = 0; first < kPacketSize; first += length)
            runs[v].push_back({first, length, 100, 200});
        add_packet_stage("attributes/runs_of_" + std::to_string(length), &KernelTable::attributes,
                         PacketMemory(),
                         AttributesCtx{runs[v].data(), static_cast<int>(runs[v].size()),
                                       kAttributes, equations.data()},
                         written);
    }
}

void add_attribute_planes() {
    static const GridTriangles grid;
    static Equations got(GridTriangles::kAttributes), want(GridTriangles::kAttributes);
    for (const int count : {4, 16, 96}) {
        add(
            "attribute_planes/triangles_" + std::to_string(count), count,
            [=](const KernelTable& table) -> std::string {
                grid.make(table, count, got);
                grid.make(table_reference(), count, want);
                for (std::size_t i = 0; i < got.rows.size(); ++i)
                    if (i % kAttributeStride < static_cast<std::size_t>(count) &&
                        !same_bits(got.rows[i], want.rows[i]))
                        return "equations";
                return "";
            },
            [=](const KernelTable& table, benchmark::State& state) {
                for (auto _ : state) {
                    grid.make(table, count, got);
                    benchmark::ClobberMemory();
                }
            });
    }
}

void add_lighting_and_encode() {
    PacketMemory packet;
    Random random(3);
    for (int k = 0; k < 12; ++k)
        for (int i = 0; i < kPacketSize; ++i) packet.attribute(k)[i] = random.real(-1.0F, 1.0F);
    LightingCtx ctx{0, {3, 4, 5}, 1.0F, {0, 0, 6}, 12, -1, -1, -1, -1};
    add_packet_stage("lighting/half_vector", &KernelTable::lighting, packet, ctx,
                     {.attributes = {12, 13, 14}});
    ctx = {0, {3, 4, 5}, 1.0F, {0, 0, 6}, 12, 15, 18, 21, 22};
    add_packet_stage("lighting/all", &KernelTable::lighting, packet, ctx,
                     {.attributes = {12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22}});
    ctx = {0, {0.6F, 0, 0.8F}, 0.0F, {0, 0, 6}, 12, 15, -1, -1, -1};
    add_packet_stage("lighting/half_vector_of_direction", &KernelTable::lighting, packet, ctx,
                     {.attributes = {12, 13, 14, 15, 16, 17}});
    ctx = {0, {3, 4, 5}, 1.0F, {0, 0, 6}, 12, -1, -1, -1, -1, 1.0F, 0, 1};
    add_packet_stage("lighting/half_vector_orthonormal", &KernelTable::lighting, packet, ctx,
                     {.attributes = {12, 13, 14}});
    add_packet_stage("encode_nine_bit", &KernelTable::encode_nine_bit, packet, EncodeCtx{0, 0},
                     {.planes = {0}});
    add_packet_stage("encode_wide", &KernelTable::encode_wide, packet, EncodeCtx{0, 0},
                     {.planes = {0}});
}

}  // namespace burnish::bench
