// What the machine's generality costs: a program of two general stages with three bilinear
// textures, run as it is bound, and as a kernel written by hand for it alone (fused_lobe.hpp). Both
// do one tile, packet by packet, from attributes to pixels, in turns; `over_fused` is the median of
// the ratios of their times, with the first and the last quarter beside it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <burnish/materials.hpp>
#include <burnish/program_text.hpp>
#include <chrono>
#include <cstring>
#include <string>
#include <vector>

#include "bench/fused_lobe.hpp"
#include "bench/run_benchmarks.hpp"
#include "core/cpu.hpp"
#include "shade/output.hpp"
#include "shade/shading.hpp"
#include "tests/kernel_packet.hpp"

namespace burnish {

#define BURNISH_YARDSTICK(isa)           \
    namespace isa {                      \
    FusedLobeKernel fused_lobe_kernel(); \
    }
#if defined(__x86_64__)
BURNISH_YARDSTICK(sse42)
BURNISH_YARDSTICK(avx2)
BURNISH_YARDSTICK(avx512)
FusedLobeKernel fused_lobe(const KernelTable& table) {
    const std::string isa = table.isa;
    if (isa == "sse42") return sse42::fused_lobe_kernel();
    if (isa == "avx2") return avx2::fused_lobe_kernel();
    if (isa == "avx512") return avx512::fused_lobe_kernel();
    return nullptr;
}
#else
BURNISH_YARDSTICK(neon64)
FusedLobeKernel fused_lobe(const KernelTable& table) {
    return std::string(table.isa) == "neon64" ? neon64::fused_lobe_kernel() : nullptr;
}
#endif

namespace {

constexpr const char* kProgram = R"(!!RC1.0
const0 = (0, 0, 0, 0.8);
const1 = (0.1, 0.05, 0.02, 1);
{
  rgb {
    spare0 = expand(tex0) . expand(col0);
    spare1 = expand(tex1) . expand(col0);
    scale_by_four();
  }
  alpha { spare0 = col0 * const0; }
}
{ rgb { discard = spare0 * spare0; discard = spare1 * spare1; spare0 = sum(); } }
final_product = tex2 * spare0.a;
out.rgb = lerp(spare0, zero, final_product) + const1;
out.a = unsigned_invert(zero);
)";

constexpr int kPackets = kTilePixels / kPacketSize;

/// A tile of fragments, one texel a pixel and a little turned, and everything that shades them.
struct Tile {
    Tile() {
        const Material steel = brushed_steel();
        ProgramMaterial material;
        material.combiners = parse_combiners(kProgram).program.value();
        material.units = {steel.tangent_map, steel.bitangent_map, steel.specular_map};
        material.col0_rgb = ColorInput::half_tangent;
        material.col0_a = ColorInput::n_dot_l;
        Machine machine = machine_profile("geforce256");
        machine.texture_units = 3;
        plan_shading(shading, {&material, 1}, machine, true);
        const Texture& map = *steel.tangent_map;
        const auto texel = 1.0F / static_cast<float>(map.width());
        Random random(7);
        for (int p = 0; p < kPackets; ++p) {
            PacketMemory& memory = packets.emplace_back();
            for (int i = 0; i < kPacketSize; ++i) {
                const int pixel = p * kPacketSize + i;
                memory.pixels[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(pixel);
                const auto x = static_cast<float>(pixel / 64 % 8 * 8 + pixel % 8);
                const auto y = static_cast<float>(pixel / 512 * 8 + pixel % 64 / 8);
                memory.attribute(0)[i] = 0.3F + (x * 0.9F - y * 0.3F) * texel;
                memory.attribute(1)[i] = 0.2F + (x * 0.3F + y * 0.9F) * texel;
                for (int k = 2; k < shading.interpolated(); ++k)
                    memory.attribute(k)[i] = random.unit();
            }
        }
        const auto plane_of = [&](Register reg, std::size_t c) {
            return shading.program.input[static_cast<std::size_t>(reg)][c];
        };
        fused.u = 0;
        fused.v = 1;
        for (const InputOp& op : shading.inputs) {
            const auto* encode = std::get_if<EncodeCtx>(&op);
            for (std::size_t c = 0; encode != nullptr && c < 4; ++c)
                if (encode->plane == plane_of(Register::col0, c))
                    fused.color[c] = encode->attribute;
        }
        for (std::size_t t = 0; t < 3; ++t) fused.texels[t] = material.units[t]->texels();
        fused.width = map.width();
        fused.height = map.height();
        fused.pitch = map.pitch();
        fused.const0_alpha = 204;  // 0.8
        fused.const1[0] = 26;      // 25.5 + 0.5
        fused.const1[1] = 13;      // 12.75 + 0.5
        fused.const1[2] = 5;       // 5.1 + 0.5
        fused.store = {{0, 1, 2, 3}, StoreFormat::rgba8, nullptr};
    }

    void run_machine(const KernelTable& table, std::vector<std::uint32_t>& pixels) {
        const OutputTile tile{StoreFormat::rgba8, pixels.data(), nullptr, nullptr};
        for (PacketMemory& memory : packets) {
            Packet packet = memory.view();
            packet.planes = planes.data();
            shade_packet(shading, table, AttributesCtx{}, packet);
            write_pixels(shading.program.result, shading.program.numbers, {}, table, tile, packet);
        }
    }
    void run_fused(FusedLobeKernel kernel, std::vector<std::uint32_t>& pixels) {
        FusedLobe ctx = fused;
        ctx.store.tile = pixels.data();
        for (PacketMemory& memory : packets) {
            Packet packet = memory.view();
            packet.planes = other_planes.data();
            kernel(packet, ctx);
        }
    }
    void load_constants() {
        Packet packet = packets.front().view();
        packet.planes = planes.data();
        burnish::load_constants(shading.program, packet);
    }

    Shading shading;
    FusedLobe fused{};
    std::vector<PacketMemory> packets;
    AlignedVector<std::int16_t> planes = AlignedVector<std::int16_t>(64 * kPacketSize);
    AlignedVector<std::int16_t> other_planes = AlignedVector<std::int16_t>(4 * kPacketSize);
};

void yardstick(benchmark::State& state, const KernelTable& table) {
    using Clock = std::chrono::steady_clock;
    const FusedLobeKernel kernel = fused_lobe(table);
    Tile tile;
    tile.load_constants();
    std::vector<std::uint32_t> want(kTilePixels), machine(kTilePixels), fused(kTilePixels);
    tile.run_machine(table_reference(), want);
    tile.run_machine(table, machine);
    tile.run_fused(kernel, fused);
    if (machine != want) return state.SkipWithError("the machine differs from the reference");
    if (fused != want) return state.SkipWithError("the yardstick differs from the reference");
    constexpr int kTiles = 8;  // 33,000 pixels between two looks at the clock
    std::vector<double> machine_ns, fused_ns, ratios;
    for (auto _ : state) {
        const auto start = Clock::now();
        for (int i = 0; i < kTiles; ++i) tile.run_machine(table, machine);
        const auto middle = Clock::now();
        for (int i = 0; i < kTiles; ++i) tile.run_fused(kernel, fused);
        const auto end = Clock::now();
        const auto per_pixel = [](Clock::duration d) {
            return std::chrono::duration<double, std::nano>(d).count() / (kTiles * kTilePixels);
        };
        machine_ns.push_back(per_pixel(middle - start));
        fused_ns.push_back(per_pixel(end - middle));
        ratios.push_back(machine_ns.back() / fused_ns.back());
    }
    const auto quantile = [](std::vector<double>& v, std::size_t quarter) {
        std::sort(v.begin(), v.end());
        return v[(v.size() - 1) * quarter / 4];
    };
    state.counters["machine_ns"] = quantile(machine_ns, 2);
    state.counters["fused_ns"] = quantile(fused_ns, 2);
    state.counters["over_fused"] = quantile(ratios, 2);
    state.counters["over_fused_q1"] = quantile(ratios, 1);
    state.counters["over_fused_q3"] = quantile(ratios, 3);
}

}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
    using namespace burnish;
    for (const KernelTable* table : available_tables()) {
        if (fused_lobe(*table) == nullptr) continue;
        benchmark::RegisterBenchmark(
            ("yardstick/two_stages_three_textures/" + std::string(table->isa)).c_str(),
            [table](benchmark::State& state) { yardstick(state, *table); });
    }
    return run_benchmarks(argc, argv);
}
