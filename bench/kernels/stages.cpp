#include "bench/kernels/stages.hpp"

#include "bench/count_instructions.hpp"
#include "bench/run_benchmarks.hpp"

namespace burnish::bench {

namespace {

bool count_only = false;

}  // namespace

void add(const std::string& name, std::int64_t items,
         const std::function<std::string(const KernelTable&)>& difference,
         const std::function<void(const KernelTable&, benchmark::State&)>& run) {
    for (const KernelTable* table : available_tables()) {
        const auto body = [=](benchmark::State& state) {
            const std::string text = difference(*table);
            if (!text.empty()) return state.SkipWithError(("not the reference: " + text).c_str());
            if (count_only) {
                run(counted_kernels(*table), state);
                state.counters["instructions"] = static_cast<double>(counted_instructions());
                return;
            }
            const std::uint64_t start = cycles_so_far();
            run(*table, state);
            count_items(state, items, cycles_so_far() - start);
        };
        auto* registered =
            benchmark::RegisterBenchmark(("stage/" + name + "/" + table->isa).c_str(), body);
        if (count_only) registered->Iterations(1);
    }
}

void count_instructions_only() {
    count_only = true;
}

void fill_planes(PacketMemory& packet, Random& random, int count, int low, int high) {
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < kPacketSize; ++i)
            packet.plane(k)[i] = static_cast<std::int16_t>(random.between(low, high));
}

PacketMemory registers(int one) {
    Random random(5);
    PacketMemory packet;
    fill_planes(packet, random, 13, 0, one);
    return packet;
}

}  // namespace burnish::bench
