#include "core/cpu.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/renderer.hpp>
#include <cstdlib>
#include <string>
#include <vector>

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace burnish {

namespace {

struct BuiltTable {
    std::string_view isa;
    bool available;
    const KernelTable& (*table)() noexcept;
};

#if defined(__x86_64__)
/// The builtin knows of it with GCC alone.
bool has_lzcnt() {
    unsigned a = 0, b = 0, c = 0, d = 0;
    return __get_cpuid(0x80000001, &a, &b, &c, &d) != 0 && (c & bit_LZCNT) != 0;
}
#endif

/// Best first. The compiler's own feature test also asks the operating system about the registers.
std::vector<BuiltTable> built_tables() {
    std::vector<BuiltTable> built;
#if defined(__x86_64__)
    __builtin_cpu_init();
    const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
                        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                        __builtin_cpu_supports("avx512vl");
    built.push_back({"avx512", avx512, table_avx512});
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
                      __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt") &&
                      has_lzcnt();
    built.push_back({"avx2", avx2, table_avx2});
    built.push_back({"sse42", __builtin_cpu_supports("sse4.2") != 0, table_sse42});
#elif defined(__aarch64__)
    built.push_back({"neon64", true, table_neon64});
#endif
    built.push_back({"reference", true, table_reference});
    return built;
}

}  // namespace

std::vector<IsaInfo> instruction_sets() {
    std::vector<IsaInfo> result;
    for (const BuiltTable& built : built_tables()) result.push_back({built.isa, built.available});
    return result;
}

std::span<const KernelTable* const> available_tables() {
    static const std::vector<const KernelTable*> tables = [] {
        std::vector<const KernelTable*> result;
        for (const BuiltTable& built : built_tables()) {
            if (built.available) result.push_back(&built.table());
        }
        return result;
    }();
    return tables;
}

const KernelTable& select_table(std::string_view name) {
    std::string source = "isa";
    if (name.empty()) {
        const char* variable = std::getenv("BURNISH_ISA");
        if (variable == nullptr || *variable == '\0') return *available_tables().front();
        name = variable;
        source = "BURNISH_ISA";
    }
    std::string known;
    for (const KernelTable* table : available_tables()) {
        if (name == table->isa) return *table;
        known += known.empty() ? "" : ", ";
        known += table->isa;
    }
    throw Error(ErrorCode::bad_option,
                fmt::format("{}: '{}' cannot run here, expected one of {}", source, name, known));
}

}  // namespace burnish
