#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>
#include <functional>
#include <string>

#include "core/cpu.hpp"
#include "tests/kernel_packet.hpp"

/// Benchmarks of every stage of every table that this CPU can run: stage/<name>/<variant>/<isa>.
/// Results are compared with the reference before anything is timed. Items are fragments, vertices
/// for `transform` and `light_vertices`, triangles for `setup`, `rasterize_tiny`, `rasterize_small`
/// and `attribute_planes`, covered pixels for `rasterize`; `cycles` are those of the time-stamp
/// counter per item, which runs at the CPU's nominal clock.
namespace burnish::bench {

/// Registers `run` for each table; `difference` is empty where the table is right.
void add(const std::string& name, std::int64_t items,
         const std::function<std::string(const KernelTable&)>& difference,
         const std::function<void(const KernelTable&, benchmark::State&)>& run);

/// From now on every kernel that is added runs once, and its instructions are counted (x86-64).
void count_instructions_only();

template <class Ctx>
using PacketStage = void (*KernelTable::*)(Packet&, const Ctx&) noexcept;

/// A kernel on a packet: ns are those of a whole one.
template <class Ctx>
void add_packet_stage(const std::string& name, PacketStage<Ctx> stage, const PacketMemory& before,
                      const Ctx& ctx, const Written& written) {
    add(
        name, before.count,
        [=](const KernelTable& table) {
            return stage_difference(table, stage, before, ctx, written);
        },
        [=](const KernelTable& table, benchmark::State& state) {
            PacketMemory memory = before;
            Packet packet = memory.view();
            for (auto _ : state) {
                (table.*stage)(packet, ctx);
                benchmark::ClobberMemory();
            }
        });
}

/// Planes 0 .. count - 1 at random.
void fill_planes(PacketMemory& packet, Random& random, int count, int low, int high);
/// Planes 0 .. 12 from 0 to 1, which is `one`.
PacketMemory registers(int one);

// One for each subject, in the order of a frame.
void add_transform();
void add_setup();
void add_light_vertices();
void add_rasterize();
void add_rasterize_depths();
void add_cover();
void add_clear();
void add_small_triangles();
void add_collect();
void add_attribute_planes();
void add_attributes();
void add_lighting_and_encode();
void add_texels();
void add_levels();
void add_texture_shader();
void add_combiners();
void add_stores();
void add_fragment_tests();

}  // namespace burnish::bench
