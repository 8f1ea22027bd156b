// Where each stage of a frame stands beside the limits of one core: ./run roofline prints the table
// of docs/performance.md. The limits are measured first, the stages come from the renderer's
// account of its frames, and what a stage has to move and to compute at least is counted below from
// its contract.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <burnish/renderer.hpp>
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "bench/cpu_name.hpp"
#include "bench/frame_scenes.hpp"
#include "bench/limits.hpp"
#include "core/aligned.hpp"
#include "core/cpu.hpp"
#include "core/stage_clock.hpp"
#include "image/stream.hpp"

namespace burnish {

#define BURNISH_LIMITS(isa)          \
    namespace isa {                  \
    const LimitLoops* limit_loops(); \
    }
#if defined(__x86_64__)
BURNISH_LIMITS(sse42)
BURNISH_LIMITS(avx2)
BURNISH_LIMITS(avx512)
const LimitLoops* limit_loops(const KernelTable& table) {
    const std::string isa = table.isa;
    if (isa == "sse42") return sse42::limit_loops();
    if (isa == "avx2") return avx2::limit_loops();
    if (isa == "avx512") return avx512::limit_loops();
    return nullptr;
}
#else
BURNISH_LIMITS(neon64)
const LimitLoops* limit_loops(const KernelTable& table) {
    return std::string(table.isa) == "neon64" ? neon64::limit_loops() : nullptr;
}
#endif

namespace {

using Clock = std::chrono::steady_clock;

/// Per nanosecond: operations on elements, bytes.
struct Limits {
    double shorts, floats;  ///< multiplications or additions of 16-bit numbers, of floats
    double pairs;           ///< loads of 8 bytes, put together to vectors
    double near, far;       ///< bytes copied in the first-level cache, out of the second-level one
    double frame;           ///< bytes written past the caches
};

/// Units of `work` per nanosecond, the best of some tries: whatever disturbs makes it slower.
template <class Body>
double best_rate(double work, Body&& body) {
    double best = 0.0;
    for (int i = 0; i < 15; ++i) {
        const auto start = Clock::now();
        body();
        const std::chrono::duration<double, std::nano> time = Clock::now() - start;
        best = std::max(best, work / time.count());
    }
    return best;
}

double copy_rate(const LimitLoops& loops, std::size_t bytes) {
    // Half a page between the two: loads that follow stores 4 KB before them would wait.
    constexpr std::size_t kGap = 1024;
    AlignedVector<std::int16_t> memory(bytes + kGap, 1);
    const std::int16_t* const from = memory.data();
    std::int16_t* const to = memory.data() + bytes / 2 + kGap;
    constexpr double kTotal = 64e6;
    const int rounds = std::max(1, static_cast<int>(kTotal / static_cast<double>(bytes)));
    return best_rate(static_cast<double>(bytes) * rounds, [&] {
        for (int i = 0; i < rounds; ++i) loops.copy(to, from, static_cast<long>(bytes));
    });
}

Limits measure_limits(const LimitLoops& loops) {
    constexpr long kCount = 100000;
    AlignedVector<std::int16_t> shorts(static_cast<std::size_t>(8 * loops.lanes16), 3);
    AlignedVector<float> floats(static_cast<std::size_t>(8 * loops.lanes32), 0.5F);
    Limits limits{};
    limits.shorts =
        best_rate(16.0 * kCount * loops.lanes16, [&] { loops.shorts(shorts.data(), kCount); });
    limits.floats =
        best_rate(16.0 * kCount * loops.lanes32, [&] { loops.floats(floats.data(), kCount); });
    std::vector<std::int32_t> offset(256);
    for (std::size_t i = 0; i < offset.size(); ++i)
        offset[i] = static_cast<std::int32_t>(i * 37 % 256 * 16);
    const std::vector<std::uint8_t> texels(8192, 1);
    limits.pairs = best_rate(256.0 * kCount / 10, [&] {
        loops.pairs(shorts.data(), texels.data(), offset.data(), kCount / 10);
    });
    limits.near = copy_rate(loops, 8 << 10);
    limits.far = copy_rate(loops, 3 << 20);
    const AlignedVector<std::byte> tile(16 << 10);
    AlignedVector<std::byte> frame(std::size_t{1} << 25);
    limits.frame = best_rate(static_cast<double>(frame.size()), [&] {
        for (std::size_t at = 0; at < frame.size(); at += tile.size())
            stream_copy(frame.data() + at, tile.data(), tile.size());
        stream_fence();
    });
    return limits;
}

/// Cycles per nanosecond: additions that wait for each other take one each.
double measure_clock() {
    constexpr long kCount = 1000000;
    return best_rate(8.0 * kCount, [] {
        long sum = 0;
        for (long i = 0; i < kCount; ++i) {
            for (int k = 0; k < 8; ++k) {
                sum += i;
                asm volatile("" : "+r"(sum));
            }
        }
    });
}

/// Nanoseconds that reading the account's clock takes.
double measure_reading() {
    constexpr int kCount = 100000;
    return 1.0 / best_rate(kCount, [] {
               std::uint64_t sum = 0;
               for (int i = 0; i < kCount; ++i) sum += ticks();
               asm volatile("" : "+r"(sum));
           });
}

/// What an item of a stage takes at least, whatever the kernels are like: elementary operations on
/// 16-bit numbers or floats (32-bit integers count as floats), loads of texel pairs, bytes that go
/// through the first-level cache, that come from or go to memory beyond it, and that leave for the
/// frame.
struct Need {
    const char* stage;
    const char* item;
    double shorts, floats, pairs, near, far, frame;
};
constexpr Need kNeeds[] = {
    // A 4 x 4 matrix (28), a division and two products for the window (5), snapping and
    // bounds (12); 12 bytes in, 32 out.
    {"transform", "vertices", 0, 45, 0, 44, 44, 0},
    // Three edges (15), the area (3), slopes of the depth (14), box and tests (20). Three
    // indices and three vertices of 16 bytes in, of which two were in the cache.
    {"setup", "triangles", 0, 52, 0, 60, 28, 0},
    // An entry of 8 bytes, written and moved to its tile's list, of a triangle of 64 bytes.
    {"bin", "triangles", 0, 4, 0, 24, 64, 0},
    // Three edges (12) and the depth (4) at the tile's origin, 64 bytes in.
    {"coverage", "tile_triangles", 0, 16, 0, 64, 64, 0},
    // Three edges and their signs (6), depth, its clamp and test and two choices (9); depth
    // and number of the triangle are kept, the pixel is listed.
    {"coverage", "fragments", 0, 15, 0, 10, 0, 0},
    // The number of the pixel, moved.
    {"packets", "fragments", 0, 1, 0, 4, 0, 0},
    // The plane (4), times w (1), and w itself, once for some six values (1).
    {"interpolate", "values", 0, 6, 0, 4, 0, 0},
    // Three lerps of four channels, each a product, a sum and a difference (36). Address and
    // weights in (8), texels in two pairs (16), channels out (8); from afar 4 bytes, at a texel
    // a pixel.
    {"texture", "samples", 36, 0, 2, 32, 4, 0},
    // Three channels of two products, a sum and two clamps; two operands in, one out.
    {"combine", "portions", 15, 0, 0, 18, 0, 0},
    // Four channels clamped and packed; 8 bytes in, 4 out.
    {"resolve", "fragments", 8, 0, 0, 12, 0, 0},
    {"resolve", "pixels", 0, 0, 0, 4, 0, 4},
};

struct Row {
    double ms = 0.0, operations = 0.0, bytes = 0.0, limit_ms = 0.0;
    std::string bound;  ///< what the limit is made of, mostly
};

/// Adds the time that `count` items of `need` take at the least.
void add_need(Row& row, const Need& need, double count, const Limits& limits) {
    const std::pair<const char*, double> times[] = {
        {"16-bit operations", need.shorts / limits.shorts},
        {"operations", need.floats / limits.floats},
        {"loads of pairs", need.pairs / limits.pairs},
        {"first-level cache", need.near / (2.0 * limits.near)},
        {"memory", need.far / (2.0 * limits.far)},
        {"frame", need.frame / limits.frame}};
    const auto longest = *std::ranges::max_element(
        times, [](const auto& a, const auto& b) { return a.second < b.second; });
    row.operations += count * (need.shorts + need.floats);
    row.bytes += count * (need.near + need.frame);
    const double ms = 1e-6 * count * longest.second;
    if (ms >= 0.5 * (row.limit_ms + ms)) row.bound = longest.first;
    row.limit_ms += ms;
}

/// The frame with the median time of all, of `seconds`.
FrameStats typical_frame(const Scene& scene, const std::string& isa, double seconds) {
    Renderer renderer({.threads = 1, .isa = isa, .accounting = true});
    Framebuffer frame(scene.width, scene.height);
    std::vector<FrameStats> frames;
    const auto start = Clock::now();
    while (frames.size() < 7 || Clock::now() - start < std::chrono::duration<double>(seconds))
        frames.push_back(renderer.render(scene, frame));
    const auto time = [](const FrameStats& f) { return f.geometry_ms + f.tiles_ms; };
    const auto middle = frames.begin() + static_cast<std::ptrdiff_t>(frames.size() / 2);
    std::nth_element(frames.begin(), middle, frames.end(),
                     [&](const auto& a, const auto& b) { return time(a) < time(b); });
    return *middle;
}

void print_table(const std::string& title, const FrameStats& frame, const Limits& limits) {
    fmt::print(
        "{}:\n\n| stage | items | ms | ns an item | operations an item | bytes an item | at least, "
        "ms | "
        "by | reached |\n|---|---|---|---|---|---|---|---|---|\n",
        title);
    double ms = 0.0, limit_ms = 0.0;
    for (const StageCost& stage : frame.stages) {
        ms += stage.name == "waiting" ? 0.0 : stage.ms;
        Row row;
        for (const Need& need : kNeeds) {
            if (need.stage != stage.name) continue;
            const bool own = need.item == stage.unit;
            add_need(row, need, static_cast<double>(own ? stage.items : frame.shaded_pixels),
                     limits);
        }
        if (row.limit_ms <= 0.0 || stage.items == 0) continue;
        limit_ms += row.limit_ms;
        const auto items = static_cast<double>(stage.items);
        fmt::print(
            "| {} | {:.3f} M {} | {:.3f} | {:.2f} | {:.0f} | {:.0f} | {:.3f} | {} | {:.0f} % |\n",
            stage.name, 1e-6 * items, stage.unit, stage.ms, 1e6 * stage.ms / items,
            row.operations / items, row.bytes / items, row.limit_ms, row.bound,
            100.0 * row.limit_ms / stage.ms);
    }
    fmt::print("| all | | {:.3f} | | | | {:.3f} | | {:.0f} % |\n\n", ms, limit_ms,
               100.0 * limit_ms / ms);
}

/// Kernels that a fragment of the modified model goes through, by the beginning of their names, and
/// what they are of its path.
constexpr std::pair<const char*, const char*> kPixelPath[] = {
    {"attributes", "interpolate"},
    {"encode_", "interpolate"},
    {"address", "3 bilinear textures"},
    {"fetch_", "3 bilinear textures"},
    {"portion_", "2 general stages"},
    {"final_", "final"},
    {"store_", "resolve"},
};

/// Cycles a fragment of the whole path; of what the account says of a kernel, reading the clock is
/// taken off, once a call. The tile's pixels go to the frame with all that lies beside.
void print_pixel_path(const FrameStats& frame, double clock, double reading_ns) {
    std::vector<std::pair<std::string, double>> parts;
    const auto add = [&](const std::string& part, double cycles) {
        if (parts.empty() || parts.back().first != part) parts.emplace_back(part, 0.0);
        parts.back().second += cycles;
    };
    double resolve_ms = 0.0, pixels = 1.0;
    for (const StageCost& stage : frame.stages) {
        if (stage.name != "resolve") continue;
        resolve_ms = stage.ms;
        pixels = static_cast<double>(stage.items);
    }
    const auto fragments = static_cast<double>(frame.shaded_pixels);
    for (const auto& [prefix, part] : kPixelPath) {
        for (const KernelCost& kernel : frame.kernels) {
            if (!kernel.name.starts_with(prefix)) continue;
            const double ns = 1e6 * kernel.ms - reading_ns * static_cast<double>(kernel.calls);
            add(part, clock * ns / fragments);
            if (kernel.stage == "resolve") resolve_ms -= kernel.ms;
        }
    }
    add("resolve", clock * 1e6 * resolve_ms / pixels);
    double sum = 0.0;
    fmt::print("A pixel of the modified model, in cycles at {:.2f} GHz:", clock);
    for (const auto& [part, cycles] : parts) {
        fmt::print(" {} {:.2f},", part, cycles);
        sum += cycles;
    }
    fmt::print(" together {:.1f}.\n\n", sum);
}

void run(const std::string& isa, double seconds) {
    const KernelTable& table = select_table(isa);
    const LimitLoops* loops = limit_loops(table);
    if (loops == nullptr) throw std::runtime_error("no limits of the reference");
    const Limits limits = measure_limits(*loops);
    fmt::print(
        "One core of {}, {}: {:.0f} G 16-bit operations and {:.0f} G operations on floats a "
        "second, {:.1f} G loads of texel pairs; copies {:.0f} GB/s in the first-level cache, "
        "{:.0f} GB/s between buffers of 3 MB; writes a frame at {:.0f} GB/s.\n\n",
        cpu_name(), table.isa, limits.shorts, limits.floats, limits.pairs, limits.near, limits.far,
        limits.frame);
    const FrameStats frame =
        typical_frame(ellipsoid_scene(144, 72, 1920, 1080), table.isa, seconds);
    print_table("S1c, 20,448 triangles, 1920 x 1080", frame, limits);
    print_pixel_path(frame, measure_clock(), measure_reading());
    print_table("S1c with 1,000,000 triangles",
                typical_frame(ellipsoid_scene(1000, 501, 1920, 1080), table.isa, seconds), limits);
}

}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
    std::string isa;
    double seconds = 0.5;
    CLI::App app("Stages of a frame beside the limits of one core.");
    app.add_option("--isa", isa);
    app.add_option("--seconds", seconds, "of frames for each scene");
    CLI11_PARSE(app, argc, argv);
    try {
        burnish::run(isa, seconds);
    } catch (const std::exception& error) {
        fmt::print(stderr, "roofline: {}\n", error.what());
        return 1;
    }
}
