#include "bench/count_instructions.hpp"

#include <csignal>

namespace burnish {
namespace {

volatile std::sig_atomic_t steps = 0;
std::uint64_t counted = 0;
const KernelTable* real = nullptr;

#if defined(__x86_64__)

constexpr unsigned long long kTrapFlag = 0x100;

/// Every instruction from here on raises SIGTRAP when it is done.
inline __attribute__((always_inline)) void start_counting() {
    steps = 0;
    __builtin_ia32_writeeflags_u64(__builtin_ia32_readeflags_u64() | kTrapFlag);
}
inline __attribute__((always_inline)) void stop_counting() {
    __builtin_ia32_writeeflags_u64(__builtin_ia32_readeflags_u64() & ~kTrapFlag);
    counted = static_cast<std::uint64_t>(steps);
}

void install_counter() {
    struct sigaction action {};
    action.sa_handler = [](int) { steps = steps + 1; };
    sigaction(SIGTRAP, &action, nullptr);
}

#else

void start_counting() {}
void stop_counting() {}
void install_counter() {}

#endif

constexpr int kFew = 128;

template <auto member, class... Arguments>
void run_counted(Arguments&... arguments) noexcept {
    const auto kernel = real->*member;
    start_counting();
    kernel(arguments...);
    stop_counting();
}
template <auto member, class Ctx>
void count(const Ctx& ctx) noexcept {
    Ctx few = ctx;
    if constexpr (requires { few.count = 1; }) few.count = few.count < kFew ? few.count : kFew;
    run_counted<member>(few);
}
template <auto member, class Ctx>
void count(Packet& packet, const Ctx& ctx) noexcept {
    run_counted<member>(packet, ctx);
}

}  // namespace

bool can_count_instructions() {
#if defined(__x86_64__)
    return true;
#else
    return false;
#endif
}

KernelTable counted_kernels(const KernelTable& table) {
    install_counter();
    real = &table;
    return {table.isa, table.lanes,
#define X(name, Ctx) count<&KernelTable::name, Ctx>,
            BURNISH_TILE_STAGES(X) BURNISH_PACKET_STAGES(X)
#undef X
    };
}

std::uint64_t counted_instructions() {
    return counted;
}

}  // namespace burnish
