#include "bench/peers/cores.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <limits>
#include <string>
#include <thread>

namespace burnish::peers {

std::vector<int> allowed_cores() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    sched_getaffinity(0, sizeof allowed, &allowed);
    std::vector<int> cores;
    for (int core = 0; core < CPU_SETSIZE; ++core)
        if (CPU_ISSET(static_cast<std::size_t>(core), &allowed)) cores.push_back(core);
    return cores;
}

void pin_thread(pid_t thread, int core) {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(core), &one);
    sched_setaffinity(thread, sizeof one, &one);
}

void spread_threads(int workers) {
    const std::vector<int> cores = allowed_cores();
    if (workers < 2 || static_cast<std::size_t>(workers) > cores.size()) return;
    std::vector<pid_t> threads;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task"))
        threads.push_back(std::stoi(entry.path().filename()));
    std::ranges::sort(threads);
    for (std::size_t i = 0; i < threads.size(); ++i)
        pin_thread(threads[i], cores[i % cores.size()]);
}

double line_transfer() {
    constexpr int kSeries = 20, kTurns = 200;
    const std::vector<int> cores = allowed_cores();
    if (cores.size() < 2) return 0.0;
    alignas(128) std::atomic<int> line{0};
    // Each waits for its number and writes the next one.
    const auto play = [&](int core, int first) {
        pin_thread(0, core);
        double least = std::numeric_limits<double>::max();
        for (int series = 0, number = first; series < kSeries; ++series) {
            const auto start = std::chrono::steady_clock::now();
            for (int turn = 0; turn < kTurns; ++turn, number += 2) {
                while (line.load(std::memory_order_acquire) != number) {
                }
                line.store(number + 1, std::memory_order_release);
            }
            const std::chrono::duration<double, std::nano> time =
                std::chrono::steady_clock::now() - start;
            least = std::min(least, time.count() / (2 * kTurns));
        }
        return least;
    };
    std::thread second(play, cores[1], 1);
    double least = 0.0;
    std::thread first([&] { least = play(cores[0], 0); });
    first.join();
    second.join();
    return least;
}

}  // namespace burnish::peers
