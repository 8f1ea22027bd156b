#include <algorithm>
#include <array>
#include <functional>
#include <string>

#include "bench/kernels/stages.hpp"

namespace burnish::bench {
namespace {

void add_store(const std::string& name,
               void (*KernelTable::*stage)(Packet&, const StoreCtx&) noexcept,
               const PacketMemory& before) {
    const std::array<const char*, 3> formats{"rgba8", "rgba16", "rgba32f"};
    for (std::size_t f = 0; f < formats.size(); ++f) {
        const auto format = static_cast<StoreFormat>(f);
        const auto store = [=](const KernelTable& table, AlignedVector<std::uint8_t>& tile) {
            PacketMemory memory = before;
            Packet packet = memory.view();
            (table.*stage)(packet, {{0, 1, 2, 3}, format, tile.data()});
        };
        add(
            name + "/" + formats[f], before.count,
            [=](const KernelTable& table) -> std::string {
                AlignedVector<std::uint8_t> got(std::size_t{16} * kTilePixels);
                AlignedVector<std::uint8_t> want = got;
                store(table, got);
                store(table_reference(), want);
                return got == want ? "" : "pixels";
            },
            [=](const KernelTable& table, benchmark::State& state) {
                AlignedVector<std::uint8_t> tile(std::size_t{16} * kTilePixels);
                PacketMemory memory = before;
                Packet packet = memory.view();
                const StoreCtx ctx{{0, 1, 2, 3}, format, tile.data()};
                for (auto _ : state) {
                    (table.*stage)(packet, ctx);
                    benchmark::ClobberMemory();
                }
            });
    }
}

/// The inverse of store, blending, and store.
void add_blend(const std::string& name,
               void (*KernelTable::*stage)(Packet&, const BlendCtx&) noexcept,
               const PacketMemory& before) {
    const std::array<const char*, 3> formats{"rgba8", "rgba16", "rgba32f"};
    for (std::size_t f = 0; f < formats.size(); ++f) {
        BlendCtx ctx{};
        for (std::int16_t c = 0; c < 4; ++c) ctx.plane[c] = c;
        ctx.format = static_cast<StoreFormat>(f);
        ctx.source = {BlendOperand::source_alpha, 0};
        ctx.destination = {BlendOperand::source_alpha, 1};
        const auto blend = [=](const KernelTable& table, AlignedVector<std::uint8_t>& tile) {
            PacketMemory memory = before;
            Packet packet = memory.view();
            BlendCtx in_tile = ctx;
            in_tile.tile = tile.data();
            (table.*stage)(packet, in_tile);
        };
        add(
            name + "/" + formats[f], before.count,
            [=](const KernelTable& table) -> std::string {
                AlignedVector<std::uint8_t> got(std::size_t{16} * (kTilePixels + 1));
                AlignedVector<std::uint8_t> want = got;
                blend(table, got);
                blend(table_reference(), want);
                return got == want ? "" : "pixels";
            },
            [=](const KernelTable& table, benchmark::State& state) {
                AlignedVector<std::uint8_t> tile(std::size_t{16} * (kTilePixels + 1));
                PacketMemory memory = before;
                Packet packet = memory.view();
                BlendCtx in_tile = ctx;
                in_tile.tile = tile.data();
                for (auto _ : state) {
                    (table.*stage)(packet, in_tile);
                    benchmark::ClobberMemory();
                }
            });
    }
}

/// A packet's list of stored pixels, and the depths of its tile.
struct TestedTile {
    AlignedVector<std::uint16_t> stored = AlignedVector<std::uint16_t>(kPacketSize + 16);
    AlignedVector<float> depth = AlignedVector<float>(kTilePixels, 0.5F);
    AlignedVector<float> block_far = AlignedVector<float>(kTileBlocks, 0.5F);
    bool operator==(const TestedTile&) const = default;
};

/// Tests of fragments; `run` does one.
void add_fragment_test(const std::string& name, const PacketMemory& before,
                       const std::function<void(const KernelTable&, Packet&, TestedTile&)>& run) {
    const auto once = [=](const KernelTable& table) {
        PacketMemory memory = before;
        Packet packet = memory.view();
        TestedTile tile;
        std::copy_n(memory.pixels.begin(), kPacketSize, tile.stored.begin());
        run(table, packet, tile);
        tile.stored.resize(kPacketSize);
        return tile;
    };
    add(
        name, before.count,
        [=](const KernelTable& table) -> std::string {
            return once(table) == once(table_reference()) ? "" : "fragments or depths";
        },
        [=](const KernelTable& table, benchmark::State& state) {
            PacketMemory memory = before;
            Packet packet = memory.view();
            TestedTile tile;
            for (auto _ : state) {
                std::copy_n(memory.pixels.begin(), kPacketSize, tile.stored.begin());
                run(table, packet, tile);
                benchmark::ClobberMemory();
            }
        });
}

}  // namespace

void add_stores() {
    const PacketMemory nine_bit = registers(255), wide = registers(16384);
    add_store("store_nine_bit", &KernelTable::store_nine_bit, nine_bit);
    add_store("store_wide", &KernelTable::store_wide, wide);
    add_blend("blend_nine_bit", &KernelTable::blend_nine_bit, nine_bit);
    add_blend("blend_wide", &KernelTable::blend_wide, wide);
}

void add_fragment_tests() {
    Random random(6);
    PacketMemory packet;
    fill_planes(packet, random, 1, 0, 255);
    for (int i = 0; i < kPacketSize; ++i) packet.attribute(0)[i] = random.real(-1.0F, 1.0F);
    add_fragment_test("alpha_test", packet, [](const auto& table, Packet& p, TestedTile& tile) {
        table.alpha_test(p, {0, 128, 0, 0, 1, tile.stored.data()});
    });
    add_fragment_test("keep", packet, [](const auto& table, Packet& p, TestedTile& tile) {
        table.keep(p, {0, tile.stored.data()});
    });
    add_fragment_test("late_depth", packet, [](const auto& table, Packet& p, TestedTile& tile) {
        const DepthRun run{0.45F, 0.001F, 0.001F, 0.0F, 1.0F, 0, kPacketSize, 0, 0};
        table.late_depth(p, {&run, 1, -1, 1, 1, 0, 1, tile.depth.data(), tile.block_far.data(),
                             tile.stored.data()});
    });
}

}  // namespace burnish::bench
