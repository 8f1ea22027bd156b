#include "core/frame_account.hpp"

#include <string_view>

namespace burnish {

thread_local StageClock* StageClock::current = nullptr;

namespace {

using Place = StageClock::Place;

/// Kernels by the beginning of their names: the stage, and whether their items are what it counts.
struct Family {
    std::string_view prefix;
    FrameStage stage;
    bool counted = false;
};
constexpr Family kFamilies[] = {
    {"transform", FrameStage::transform, true},
    {"light_vertices", FrameStage::transform},
    {"setup", FrameStage::setup},
    {"clear_words", FrameStage::coverage},
    {"rasterize", FrameStage::coverage, true},
    {"cover", FrameStage::coverage, true},
    {"collect", FrameStage::coverage},
    {"attributes", FrameStage::interpolate, true},
    {"attribute_planes", FrameStage::interpolate},
    {"lighting", FrameStage::interpolate},
    {"encode_", FrameStage::interpolate},
    {"fetch_", FrameStage::texture, true},
    {"prefetch_", FrameStage::texture},
    {"look_up_table", FrameStage::texture, true},
    {"average_table", FrameStage::texture},
    {"address", FrameStage::texture},
    {"decode_", FrameStage::texture},
    {"affine", FrameStage::texture},
    {"dot_product", FrameStage::texture},
    {"hemisphere", FrameStage::texture},
    {"offset", FrameStage::texture},
    {"reflect", FrameStage::texture},
    {"quotient", FrameStage::texture},
    {"angle", FrameStage::texture},
    {"cull", FrameStage::texture},
    {"dim_", FrameStage::texture},
    {"cube_face", FrameStage::texture},
    {"plane_footprint", FrameStage::texture},
    {"quad_footprint", FrameStage::texture},
    {"probe_", FrameStage::texture},
    {"level_", FrameStage::texture},
    {"blend_levels", FrameStage::texture},
    {"hilo", FrameStage::texture},
    {"texel_corner", FrameStage::texture},
    {"filter_", FrameStage::texture},
    {"portion_", FrameStage::combine, true},
    {"final_", FrameStage::combine},
    {"store_", FrameStage::resolve},
    {"blend_", FrameStage::resolve},
    {"alpha_test", FrameStage::resolve},
    {"keep", FrameStage::resolve},
    {"late_depth", FrameStage::resolve},
};

consteval Family family_of(std::string_view kernel) {
    for (const Family& family : kFamilies)
        if (kernel.starts_with(family.prefix)) return family;
    throw "a kernel of stage_list.hpp belongs to no stage: add it to kFamilies";
}

struct Kernel {
    std::string_view name;
    Family family;
};
constexpr Kernel kKernels[] = {
#define X(name, Ctx) {#name, family_of(#name)},
    BURNISH_TILE_STAGES(X) BURNISH_PACKET_STAGES(X)
#undef X
};

struct Stage {
    std::string_view name, unit;
};
constexpr Stage kStages[] = {
#define X(name, unit) {#name, #unit},
    BURNISH_FRAME_STAGES(X)
#undef X
};

/// What a kernel is asked to do: elements of the argument, times fragments for those on a packet.
template <class Ctx>
std::uint64_t elements(const Ctx& ctx) {
    if constexpr (requires { ctx.attribute_count; }) {
        return static_cast<std::uint64_t>(ctx.attribute_count);
    } else if constexpr (requires { ctx.count; }) {
        return static_cast<std::uint64_t>(ctx.count);
    } else {
        return 1;
    }
}

template <KernelNumber kernel, auto member, class... Arguments>
void run_timed(std::uint64_t items, Arguments&&... arguments) noexcept {
    StageClock& clock = *StageClock::current;
    constexpr Place place = StageClock::place(kernel);
    const Place before = clock.enter(place);
    (clock.kernels().*member)(arguments...);
    clock.count(place, items);
    clock.enter(before);
}
template <KernelNumber kernel, auto member, class Ctx>
void timed(const Ctx& ctx) noexcept {
    run_timed<kernel, member>(elements(ctx), ctx);
}
template <KernelNumber kernel, auto member, class Ctx>
void timed(Packet& packet, const Ctx& ctx) noexcept {
    run_timed<kernel, member>(static_cast<std::uint64_t>(packet.count) * elements(ctx), packet,
                              ctx);
}

KernelTable timed_table(const KernelTable& real) {
    return {real.isa, real.lanes,
#define X(name, Ctx) timed<KernelNumber::name, &KernelTable::name, Ctx>,
            BURNISH_TILE_STAGES(X) BURNISH_PACKET_STAGES(X)
#undef X
    };
}

}  // namespace

FrameAccount::FrameAccount(const KernelTable& kernels, int workers)
    : m_timed(timed_table(kernels)),
      m_clocks(static_cast<std::size_t>(workers), StageClock(kernels)) {}

void FrameAccount::start(std::size_t tiles) {
    for (StageClock& clock : m_clocks) clock.reset();
    m_tiles.assign(tiles, {});
    m_start = std::chrono::steady_clock::now();
    m_start_ticks = ticks();
}

void FrameAccount::add_tile(std::size_t i, std::uint64_t ticks, std::uint32_t weight,
                            std::uint64_t fragments) {
    m_tiles[i].weight += weight;
    m_tiles[i].ticks += ticks;
    m_tiles[i].fragments += fragments;
}

void FrameAccount::finish(FrameStats& stats) const {
    const std::chrono::duration<double, std::milli> time =
        std::chrono::steady_clock::now() - m_start;
    const double ms_per_tick = time.count() / static_cast<double>(ticks() - m_start_ticks);
    const auto total = [&](Place place) {
        StageClock::Cost sum;
        for (const StageClock& clock : m_clocks) {
            sum.ticks += clock.cost(place).ticks;
            sum.calls += clock.cost(place).calls;
            sum.items += clock.cost(place).items;
        }
        return sum;
    };
    const auto milliseconds = [&](std::uint64_t t) { return static_cast<double>(t) * ms_per_tick; };
    for (std::size_t i = 0; i < std::size(kStages); ++i) {
        const StageClock::Cost own = total(static_cast<Place>(i));
        stats.stages.push_back(
            {kStages[i].name, kStages[i].unit, milliseconds(own.ticks), own.calls, own.items});
    }
    for (std::size_t i = 0; i < std::size(kKernels); ++i) {
        const StageClock::Cost cost = total(StageClock::place(static_cast<KernelNumber>(i)));
        if (cost.calls == 0) continue;
        const Family& family = kKernels[i].family;
        StageCost& stage = stats.stages[static_cast<std::size_t>(family.stage)];
        stage.ms += milliseconds(cost.ticks);
        stage.calls += cost.calls;
        if (family.counted) stage.items += cost.items;
        stats.kernels.push_back(
            {kKernels[i].name, stage.name, milliseconds(cost.ticks), cost.calls, cost.items});
    }
    StageCost& packets = stats.stages[static_cast<std::size_t>(FrameStage::packets)];
    for (const Tile& tile : m_tiles) {
        packets.items += tile.fragments;
        stats.tile_costs.push_back({milliseconds(tile.ticks), tile.fragments, tile.weight});
    }
    StageCost& waiting = stats.stages[static_cast<std::size_t>(FrameStage::waiting)];
    waiting.ms = static_cast<double>(m_clocks.size()) * time.count();
    for (const StageCost& stage : stats.stages)
        if (&stage != &waiting) waiting.ms -= stage.ms;
}

}  // namespace burnish
