#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>

#include "bench/cpu_name.hpp"
#include "core/cpu.hpp"

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

/// What the benchmark programs have in common.
namespace burnish {

/// The time-stamp counter, which runs at the CPU's nominal clock; 0 where there is none.
inline std::uint64_t cycles_so_far() {
#if defined(__x86_64__)
    return __rdtsc();
#else
    return 0;
#endif
}

/// Items per second, and cycles per item as the counter `cycles`.
inline void count_items(benchmark::State& state, std::int64_t items, std::uint64_t cycles) {
    const std::int64_t done = state.iterations() * items;
    state.SetItemsProcessed(done);
    if (cycles > 0)
        state.counters["cycles"] = static_cast<double>(cycles) / static_cast<double>(done);
}

/// Runs what is registered and asked for, with the processor and its instruction sets in front; the
/// program's exit code.
inline int run_benchmarks(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    std::string isas;
    for (const KernelTable* table : available_tables())
        isas += (isas.empty() ? "" : ", ") + std::string(table->isa);
    benchmark::AddCustomContext("isa", isas);
    benchmark::AddCustomContext("cpu", cpu_name());
#if defined(__clang__)
    benchmark::AddCustomContext("compiler", __VERSION__);
#else
    benchmark::AddCustomContext("compiler", "GCC " __VERSION__);
#endif
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

}  // namespace burnish
