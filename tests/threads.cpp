// Many small frames with every number of workers: what the thread sanitizer is run on, and a hunt
// for schedules that change a picture. Build with BURNISH_THREADS=std for the sanitizer.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <burnish/error.hpp>
#include <chrono>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <string_view>
#include <thread>
#include <utility>

#include "core/parallel.hpp"
#include "tests/scenes.hpp"

namespace burnish {
namespace {

bool same(const Framebuffer& a, const Framebuffer& b) {
    const std::size_t row = static_cast<std::size_t>(a.width()) * pixel_size(a.format());
    for (int y = 0; y < a.height(); ++y) {
        if (std::memcmp(a.row(y), b.row(y), row) != 0) return false;
    }
    return true;
}

/// Scenes with meshes and with raw vertices, one of them with more objects than one.
std::vector<Scene> small_scenes() {
    std::vector<Scene> result{scenes::near_plane(), scenes::machine(), scenes::ellipsoid()};
    Scene knot = scenes::knot();
    knot.objects[0].geometry = Mesh(shapes::torus_knot(60, 8));
    knot.objects.push_back({knot.objects[0].geometry,
                            knot.objects[0].material,
                            placement({0.2F, 0.1F, 0.5F}, {0.0F, 1.0F, 0.0F}, 50.0F, 0.4F),
                            {}});
    result.push_back(std::move(knot));
    return result;
}

constexpr int kWidth = 150, kHeight = 100;  // 3 x 2 tiles

TEST(Threads, EveryFrameIsTheOneThreadedFrame) {
    const std::vector<Scene> scenes = small_scenes();
    std::vector<Framebuffer> want;
    std::vector<FrameStats> counts;
    Renderer alone({.threads = 1});
    for (const Scene& scene : scenes) {
        want.emplace_back(kWidth, kHeight);
        counts.push_back(alone.render(scene, want.back()));
    }
    for (int threads = 2; threads <= 8; ++threads) {
        Renderer renderer({.threads = threads});
        Framebuffer frame(kWidth, kHeight);
        for (int round = 0; round < 5; ++round) {
            for (std::size_t i = 0; i < scenes.size(); ++i) {
                const FrameStats stats = renderer.render(scenes[i], frame);
                ASSERT_TRUE(same(frame, want[i])) << "scene " << i << ", " << threads << " threads";
                EXPECT_EQ(stats.binned_triangles, counts[i].binned_triangles);
                EXPECT_EQ(stats.shaded_pixels, counts[i].shaded_pixels);
                EXPECT_EQ(stats.clipped_triangles, counts[i].clipped_triangles);
                ASSERT_EQ(stats.tiles_per_worker.size(), static_cast<std::size_t>(threads));
                EXPECT_EQ(std::accumulate(stats.tiles_per_worker.begin(),
                                          stats.tiles_per_worker.end(), std::uint64_t{0}),
                          6U);
            }
        }
    }
}

// Neither the picture nor the number of flushes depends on which chunks were ready first.
TEST(Threads, FlushedFramesAreTheSame) {
    const std::vector<Scene> scenes = small_scenes();
    for (const Scene& scene : scenes) {
        Framebuffer want(kWidth, kHeight), frame(kWidth, kHeight);
        Renderer({.threads = 1}).render(scene, want);
        for (const std::size_t cap : {std::size_t{0}, std::size_t{1}, std::size_t{20000}}) {
            const std::uint64_t flushes =
                Renderer({.threads = 1, .memory_cap = cap}).render(scene, frame).flushes;
            EXPECT_GE(flushes, cap <= 1 ? 1U : 0U);
            for (int threads = 1; threads <= 8; ++threads) {
                Renderer renderer({.threads = threads, .memory_cap = cap});
                for (int round = 0; round < 3; ++round) {
                    const FrameStats stats = renderer.render(scene, frame);
                    ASSERT_TRUE(same(frame, want)) << threads << " threads, cap " << cap;
                    ASSERT_EQ(stats.flushes, flushes) << threads << " threads, cap " << cap;
                }
            }
        }
    }
}

// Renderers on several threads at once share the scene and its textures and nothing else.
TEST(Threads, RenderersDoNotDisturbEachOther) {
    const std::vector<Scene> scenes = small_scenes();
    std::vector<Framebuffer> want;
    for (const Scene& scene : scenes) {
        want.emplace_back(kWidth, kHeight);
        Renderer({.threads = 1}).render(scene, want.back());
    }
    std::atomic<int> wrong{0};
    std::vector<std::thread> callers;
    for (int caller = 0; caller < 3; ++caller) {
        callers.emplace_back([&, caller] {
            Renderer renderer({.threads = caller + 1});
            Framebuffer frame(kWidth, kHeight);
            for (int round = 0; round < 4; ++round) {
                for (std::size_t i = 0; i < scenes.size(); ++i) {
                    renderer.render(scenes[i], frame);
                    if (!same(frame, want[i])) ++wrong;
                }
            }
        });
    }
    for (std::thread& caller : callers) caller.join();
    EXPECT_EQ(wrong, 0);
}

// Errors are thrown before a worker is at work, and leave a renderer that draws.
TEST(Threads, ARefusedSceneLeavesTheRendererUsable) {
    const std::vector<Scene> scenes = small_scenes();
    Scene bad = scenes[0];
    bad.lights.resize(9);  // one more than there may be
    Renderer renderer({.threads = 4});
    Framebuffer want(kWidth, kHeight), frame(kWidth, kHeight);
    Renderer({.threads = 1}).render(scenes[0], want);
    for (int round = 0; round < 3; ++round) {
        EXPECT_THROW(renderer.render(bad, frame), Error);
        renderer.render(scenes[0], frame);
        EXPECT_TRUE(same(frame, want));
    }
}

/// A frame of several tiles in each worker's part: machines, one that flushes, double precision.
struct LongFrame {
    Scene scene;
    std::size_t memory_cap = RendererOptions{}.memory_cap;
    std::size_t tiles;
};

constexpr int kLongWidth = 300, kLongHeight = 200;

std::vector<LongFrame> long_frames() {
    Scene exact = scenes::knot();
    exact.machine = machine_profile("double");
    return {{.scene = scenes::knot(), .tiles = 5 * 4},
            {.scene = scenes::knot(), .memory_cap = 20000, .tiles = 5 * 4},
            {.scene = exact, .tiles = 19 * 13}};
}

// After the caller's word no tile is begun: those that workers have in hand are finished. The next
// frame of the same renderer has every bit.
TEST(Threads, AStoppedFrameEndsAndTheNextIsWhole) {
    for (const LongFrame& frame : long_frames()) {
        Framebuffer want(kLongWidth, kLongHeight), got(kLongWidth, kLongHeight);
        Renderer({.threads = 1, .memory_cap = frame.memory_cap}).render(frame.scene, want);
        for (const int threads : {1, 3}) {
            std::atomic<int> tiles{0};
            int enough = 0;
            Renderer renderer({.threads = threads,
                               .memory_cap = frame.memory_cap,
                               .progress = [&](std::size_t, std::size_t) { ++tiles; },
                               .stop = [&] { return tiles >= enough; }});
            for (enough = 0; enough < 15; ++enough) {
                tiles = 0;
                try {
                    renderer.render(frame.scene, got);
                    ADD_FAILURE() << "nobody listened after " << enough << " tiles";
                } catch (const Error& error) {
                    EXPECT_EQ(error.code(), ErrorCode::stopped) << error.what();
                }
                EXPECT_LT(tiles, enough + threads);
            }
            enough = std::numeric_limits<int>::max();
            renderer.render(frame.scene, got);
            EXPECT_TRUE(same(got, want)) << threads << " threads";
        }
    }
}

TEST(Threads, ProgressReachesTheLastTileOnce) {
    for (const LongFrame& frame : long_frames()) {
        for (const int threads : {1, 3}) {
            std::vector<std::size_t> told;
            std::mutex mutex;
            Renderer renderer({.threads = threads,
                               .memory_cap = frame.memory_cap,
                               .progress = [&](std::size_t done, std::size_t total) {
                                   const std::lock_guard lock(mutex);
                                   EXPECT_EQ(total, frame.tiles);
                                   told.push_back(done);
                               }});
            Framebuffer target(kLongWidth, kLongHeight);
            const FrameStats stats = renderer.render(frame.scene, target);
            EXPECT_EQ(told.size(), frame.tiles * (stats.flushes + 1));
            if (threads == 1) {
                EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
            }
            EXPECT_EQ(std::count(told.begin(), told.end(), frame.tiles), 1);
            EXPECT_EQ(*std::max_element(told.begin(), told.end()), frame.tiles);
        }
    }
}

std::map<std::string_view, StageCost> by_name(const FrameStats& stats) {
    std::map<std::string_view, StageCost> stages;
    for (const StageCost& stage : stats.stages) stages[stage.name] = stage;
    return stages;
}

std::uint64_t fragments_of_tiles(const FrameStats& stats) {
    std::uint64_t sum = 0;
    for (const TileCost& tile : stats.tile_costs) sum += tile.fragments;
    return sum;
}

// Looking at the clock changes no pixel; every moment of every worker is in one stage, so stages
// add up to workers x frame and each kernel is a part of its stage; what is counted is what the
// frame's counts say, however many workers shared it and however often the bins were flushed.
TEST(Threads, AccountsAreComplete) {
    const std::vector<Scene> scenes = small_scenes();
    for (const Scene& scene : scenes) {
        Framebuffer want(kWidth, kHeight), frame(kWidth, kHeight);
        EXPECT_TRUE(Renderer({.threads = 1}).render(scene, want).stages.empty());
        std::vector<std::uint64_t> alone;
        for (const int threads : {1, 2, 5}) {
            for (const std::size_t cap : {std::size_t{1} << 28, std::size_t{1}}) {
                Renderer renderer({.threads = threads, .memory_cap = cap, .accounting = true});
                renderer.render(scene, frame);
                const auto start = std::chrono::steady_clock::now();
                const FrameStats stats = renderer.render(scene, frame);
                const std::chrono::duration<double, std::milli> time =
                    std::chrono::steady_clock::now() - start;
                ASSERT_TRUE(same(frame, want)) << threads << " threads";
                auto stages = by_name(stats);
                double sum = 0.0;
                std::vector<std::uint64_t> counts;
                for (const StageCost& stage : stats.stages) {
                    sum += stage.ms;
                    if (stage.name != "bin") counts.push_back(stage.items);  // binned again
                }
                EXPECT_LE(sum, threads * time.count());
                EXPECT_GE(sum, threads * (stats.geometry_ms + stats.tiles_ms));
                for (const KernelCost& kernel : stats.kernels) stages[kernel.stage].ms -= kernel.ms;
                stages.erase("waiting");
                for (const auto& [name, stage] : stages) EXPECT_GE(stage.ms, -1e-9) << name;
                EXPECT_EQ(stages["prepare"].items, scene.objects.size());
                EXPECT_EQ(stages["packets"].items, stats.shaded_pixels);
                EXPECT_EQ(fragments_of_tiles(stats), stats.shaded_pixels);
                EXPECT_EQ(stats.tile_costs.size(), 6U);
                if (cap == 1) continue;
                EXPECT_EQ(stages["setup"].items, stats.triangles);
                EXPECT_GE(stages["bin"].items, stats.binned_triangles);  // some miss all pixels
                EXPECT_EQ(stages["resolve"].items, std::uint64_t{kWidth * kHeight});
                if (alone.empty()) alone = counts;
                EXPECT_EQ(counts, alone) << threads << " threads";
            }
        }
    }
}

TEST(WorkerPool, CallsEveryWorkerOnce) {
    for (int size = 1; size <= 8; ++size) {
        WorkerPool pool(size);
        for (int round = 0; round < 200; ++round) {
            std::vector<int> calls(static_cast<std::size_t>(size), 0);
            pool.run([&](int worker) { ++calls[static_cast<std::size_t>(worker)]; });
            for (const int n : calls) ASSERT_EQ(n, 1);
        }
    }
}

TEST(WorkerPool, HandsOutEveryIndexOnce) {
    for (const int size : {1, 2, 5, 8}) {
        WorkerPool pool(size);
        for (const std::size_t count : {0U, 1U, 7U, 1000U}) {
            for (const std::size_t grain : {1U, 3U, 64U}) {
                std::vector<std::atomic<int>> taken(count);
                for_each_index(pool, count, grain, [&](std::size_t i, int worker) {
                    ++taken[i];
                    EXPECT_LT(worker, size);
                });
                for (const auto& n : taken) ASSERT_EQ(n, 1) << count << " by " << grain;
            }
        }
    }
}

// Heavy pieces go first, the heaviest in front; the rest by owners, in its order.
TEST(WorkOrder, HeavyPiecesComeFirst) {
    WorkOrder order;
    std::vector<PieceOutlook> outlook(100);
    for (std::uint32_t i = 0; i < 100; ++i) outlook[i] = {1, i % 2};
    outlook[40].weight = 50;
    outlook[70].weight = 60;
    outlook[10].weight = outlook[11].weight = 0;
    order_work(outlook, 2, order);  // of 206: more than 206 / 32 is heavy
    ASSERT_EQ(order.pieces.size(), 100U);
    ASSERT_EQ(order.shared, 2U);
    EXPECT_EQ(order.pieces[0], 70U);
    EXPECT_EQ(order.pieces[1], 40U);
    ASSERT_EQ(order.ends, (std::vector<std::size_t>{50, 100}));
    // The first part: even numbers but 10, 40 and 70, then 10 as half of the weightless.
    EXPECT_EQ(order.pieces[2], 0U);
    EXPECT_EQ(order.pieces[48], 98U);
    EXPECT_EQ(order.pieces[49], 10U);
    EXPECT_EQ(order.pieces[50], 1U);
    EXPECT_EQ(order.pieces[99], 11U);
}

TEST(WorkOrder, OneWorkerTakesThemAsTheyCome) {
    WorkOrder order;
    order_work(std::vector<PieceOutlook>{{7, 0}, {1000, 0}, {7, 0}}, 1, order);
    EXPECT_EQ(order.pieces, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(order.shared, 0U);
    order_work({}, 8, order);
    EXPECT_TRUE(order.pieces.empty());
    EXPECT_EQ(order.ends.size(), 8U);
}

// Two workers and five pieces. To whoever is free: 1 1, 1 1, then 4 alone: 2 + 4. The long one
// first: 4 beside 1 + 1 + 1 + 1. In parts {1, 1} and {1, 1, 4}: after 2 one of them begins the 4.
// Three workers, all in the second's part: the others help at once, 4 begins after 2 of 1 are done
// by two of them and one by the third.
TEST(WorkOrder, FinishingTimesOfASmallSchedule) {
    const std::vector<double> cost{1.0, 1.0, 1.0, 1.0, 4.0};
    EXPECT_EQ(finishing_time(cost, {{0, 1, 2, 3, 4}, 5, {5, 5}}), 6.0);
    EXPECT_EQ(finishing_time(cost, {{4, 0, 1, 2, 3}, 1, {3, 5}}), 4.0);
    EXPECT_EQ(finishing_time(cost, {{0, 1, 2, 3, 4}, 0, {2, 5}}), 6.0);
    EXPECT_EQ(finishing_time(cost, {{0, 1, 2, 3, 4}, 0, {5}}), 8.0);
    EXPECT_EQ(finishing_time(cost, {{0, 1, 2, 3, 4}, 0, {0, 5, 5}}), 5.0);
    EXPECT_EQ(finishing_time({}, {{}, 0, {0, 0, 0}}), 0.0);
    // 34 in one part: to one worker two at once, 30 + 30, to the other the rest. One by one it
    // would be 30 and half of the rest each.
    std::vector<double> many(34, 1.0);
    many[0] = many[1] = 30.0;
    WorkOrder order{std::vector<std::uint32_t>(34), 0, {34, 34}};
    std::iota(order.pieces.begin(), order.pieces.end(), 0U);
    EXPECT_EQ(finishing_time(many, order), 60.0);
}

TEST(WorkOrder, EveryPieceIsHandedOutOnce) {
    WorkOrder order;
    for (const int size : {1, 2, 5, 8}) {
        std::vector<PieceOutlook> outlook(1000);
        for (std::uint32_t i = 0; i < 1000; ++i)
            outlook[i] = {i * i % 997 * (i % 250 == 1 ? 100 : i % 3),
                          i * 7 % static_cast<std::uint32_t>(size)};
        WorkerPool pool(size);
        order_work(outlook, size, order);
        std::vector<std::atomic<int>> taken(outlook.size());
        // An end for each worker, and one on every thread after all that it did.
        std::atomic<int> ends{0}, without_end{0};
        static thread_local bool has_work = false;
        const auto body = [&](std::size_t i, int) {
            ++taken[i];
            if (!std::exchange(has_work, true)) ++without_end;
        };
        for_each_piece(pool, order, body, [&] {
            ++ends;
            if (std::exchange(has_work, false)) --without_end;
        });
        for (const auto& n : taken) ASSERT_EQ(n, 1) << size << " workers";
        EXPECT_EQ(ends, size);
        EXPECT_EQ(without_end, 0);
    }
}

TEST(WorkerPool, AnErrorOfAWorkerReachesTheCaller) {
    for (const int size : {1, 2, 6}) {
        WorkerPool pool(size);
        for (int thrower = 0; thrower < size; ++thrower) {
            EXPECT_THROW(pool.run([&](int worker) {
                if (worker == thrower) throw Error(ErrorCode::limit, "on purpose");
            }),
                         Error);
            std::atomic<int> calls{0};
            pool.run([&](int) { ++calls; });
            EXPECT_EQ(calls, size);
        }
    }
}

}  // namespace
}  // namespace burnish
