#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "kernels/kernel_table.hpp"

namespace burnish {

/// What the time of a frame is divided into, and what each stage counts; docs/performance.md says
/// what belongs where.
#define BURNISH_FRAME_STAGES(X) \
    X(prepare, draws)           \
    X(transform, vertices)      \
    X(setup, triangles)         \
    X(bin, triangles)           \
    X(coverage, tile_triangles) \
    X(packets, fragments)       \
    X(interpolate, values)      \
    X(texture, samples)         \
    X(combine, portions)        \
    X(resolve, pixels)          \
    X(waiting, workers)

enum class FrameStage : std::uint8_t {
#define X(name, unit) name,
    BURNISH_FRAME_STAGES(X)
#undef X
        count
};

/// The stages of kernels/stage_list.hpp, numbered.
enum class KernelNumber : std::uint8_t {
#define X(name, Ctx) name,
    BURNISH_TILE_STAGES(X) BURNISH_PACKET_STAGES(X)
#undef X
        count
};

/// A cheap clock: the time-stamp counter, or nanoseconds where there is none. Its unit is found by
/// comparing it with another clock over the frame.
inline std::uint64_t ticks() {
#if defined(__x86_64__)
    return __builtin_ia32_rdtsc();
#else
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

/// One worker's time: every moment between `resume` and `pause` is that of one stage or kernel.
class alignas(64) StageClock {
  public:
    /// A stage outside its kernels, or a kernel.
    using Place = std::uint8_t;
    static constexpr std::size_t kStages = static_cast<std::size_t>(FrameStage::count);
    static constexpr std::size_t kKernels = static_cast<std::size_t>(KernelNumber::count);
    struct Cost {
        std::uint64_t ticks = 0, calls = 0, items = 0;
    };

    explicit StageClock(const KernelTable& kernels) : m_kernels(&kernels) {}

    static constexpr Place place(FrameStage stage) { return static_cast<Place>(stage); }
    static constexpr Place place(KernelNumber kernel) {
        return static_cast<Place>(kStages + static_cast<std::size_t>(kernel));
    }

    [[nodiscard]] Place place() const { return m_place; }
    /// Time is `place`'s from now on; returns whose it was.
    Place enter(Place place) {
        const std::uint64_t now = ticks();
        m_costs[m_place].ticks += now - m_last;
        m_last = now;
        const Place before = m_place;
        m_place = place;
        return before;
    }
    void count(Place place, std::uint64_t items) {
        ++m_costs[place].calls;
        m_costs[place].items += items;
    }
    void resume(Place place) {
        m_last = ticks();
        m_place = place;
    }
    void pause() { enter(m_place); }

    /// What the timed kernels run.
    [[nodiscard]] const KernelTable& kernels() const { return *m_kernels; }
    [[nodiscard]] const Cost& cost(Place place) const { return m_costs[place]; }
    void reset() { m_costs = {}; }

    /// The calling thread's; null unless a frame is being accounted for.
    static thread_local StageClock* current;

  private:
    const KernelTable* m_kernels;
    std::uint64_t m_last = 0;
    Place m_place = 0;
    std::array<Cost, kStages + kKernels> m_costs{};
};

/// Gives the time until its end to a stage and counts it once, if there is a clock.
class StageScope {
  public:
    explicit StageScope(FrameStage stage, std::uint64_t items = 0,
                        StageClock* clock = StageClock::current)
        : m_clock(clock) {
        if (m_clock == nullptr) return;
        m_clock->count(StageClock::place(stage), items);
        m_before = m_clock->enter(StageClock::place(stage));
    }
    ~StageScope() {
        if (m_clock != nullptr) m_clock->enter(m_before);
    }
    StageScope(const StageScope&) = delete;
    StageScope& operator=(const StageScope&) = delete;

  private:
    StageClock* m_clock;
    StageClock::Place m_before = 0;
};

/// Lends a clock to the calling thread.
class ClockLoan {
  public:
    ClockLoan(StageClock& clock, StageClock::Place place)
        : m_clock(&clock), m_before(StageClock::current) {
        clock.resume(place);
        StageClock::current = &clock;
    }
    ~ClockLoan() {
        m_clock->pause();
        StageClock::current = m_before;
    }
    ClockLoan(const ClockLoan&) = delete;
    ClockLoan& operator=(const ClockLoan&) = delete;

  private:
    StageClock *m_clock, *m_before;
};

}  // namespace burnish
