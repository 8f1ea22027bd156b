#include "core/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <burnish/error.hpp>
#include <cfenv>
#include <cstdint>
#include <exception>
#include <span>
#include <thread>
#include <vector>

#include "core/frame_account.hpp"

#ifdef BURNISH_THREADS_TBB
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#else
#include <condition_variable>
#include <mutex>
#include <system_error>
#endif

namespace burnish {

namespace {

constexpr int kMaxWorkers = 1024;

/// The default floating-point environment, for the caller's thread and the workers alike: rounding
/// to nearest, no flush to zero. Restored on exit.
class FloatEnvironment {
  public:
    FloatEnvironment() {
        std::fegetenv(&m_saved);
        std::fesetenv(FE_DFL_ENV);
    }
    ~FloatEnvironment() { std::fesetenv(&m_saved); }
    FloatEnvironment(const FloatEnvironment&) = delete;
    FloatEnvironment& operator=(const FloatEnvironment&) = delete;

  private:
    std::fenv_t m_saved;
};

/// A part of the work, for one worker as long as there are others.
struct alignas(64) Share {
    std::atomic<std::size_t> next{0};
    std::size_t end = 0;
    std::atomic<bool> begun{false};

    /// `some(left)` at a time.
    template <class Some, class Body>
    void work_off(const Some& some, const Body& body) {
        for (;;) {
            const std::size_t seen = next.load(std::memory_order_relaxed);
            if (seen >= end) return;
            const std::size_t count = some(end - seen);
            const std::size_t begin = next.fetch_add(count, std::memory_order_relaxed);
            for (std::size_t i = begin; i < std::min(end, begin + count); ++i) body(i);
        }
    }
};

/// Numbers 0 .. shared - 1 to whoever is free, then the parts that end at `ends`, `some(left)` at a
/// time; then at_end(), once on each thread.
template <class Some, class Body, class End>
void hand_out(WorkerPool& pool, std::size_t shared, std::span<const std::size_t> ends,
              const Some& some, const Body& body, const End& at_end) {
    const std::size_t workers = ends.size();
    Share first;
    first.end = shared;
    std::vector<Share> shares(workers);
    for (std::size_t i = 0; i < workers; ++i) {
        shares[i].next = i > 0 ? ends[i - 1] : shared;
        shares[i].end = ends[i];
    }
    pool.run([&](int worker) {
        const auto take = [&](std::size_t i) { body(i, worker); };
        if (shared > 0) first.work_off([](std::size_t) { return std::size_t{1}; }, take);
        const auto share = [&](std::size_t k) -> Share& {
            return shares[(static_cast<std::size_t>(worker) + k) % workers];
        };
        // With more workers than cores some come late, and others have their shares by then.
        for (std::size_t k = 0; k < workers; ++k)
            if (!share(k).begun.exchange(true, std::memory_order_relaxed))
                share(k).work_off(some, take);
        for (std::size_t k = 0; k < workers; ++k) share(k).work_off(some, take);
        at_end();
    });
}

int checked_size(int workers) {
    if (workers < 0 || workers > kMaxWorkers) {
        throw Error(ErrorCode::bad_option,
                    fmt::format("threads: {} found, expected 0 .. {}", workers, kMaxWorkers));
    }
    if (workers > 0) return workers;
    return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMaxWorkers);
}

}  // namespace

#ifdef BURNISH_THREADS_TBB

struct WorkerPool::Backend {
    explicit Backend(int workers) : arena(workers) {
        // TBB otherwise never runs more threads than there are cores. Of several controls the
        // smallest counts, so there is one for the whole process.
        static const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                               kMaxWorkers);
    }

    /// The caller is worker 0; the others are tasks of an arena with exactly `workers` slots.
    void run(int workers, const std::function<void(int)>& body) {
        arena.execute([&] {
            tbb::task_group group;
            for (int w = 1; w < workers; ++w) {
                group.run([&body, w] {
                    const FloatEnvironment environment;
                    body(w);
                });
            }
            std::exception_ptr failure;
            try {
                const FloatEnvironment environment;
                body(0);
            } catch (...) {
                failure = std::current_exception();
            }
            group.wait();
            if (failure) std::rethrow_exception(failure);
        });
    }

    tbb::task_arena arena;
};

#else

struct WorkerPool::Backend {
    explicit Backend(int workers) {
        try {
            for (int w = 1; w < workers; ++w) threads.emplace_back([this, w] { work(w); });
        } catch (const std::system_error&) {
            stop();
            throw Error(ErrorCode::limit,
                        fmt::format("threads: the system has no more than {} of {}",
                                    threads.size() + 1, workers));
        } catch (...) {
            stop();
            throw;
        }
    }
    ~Backend() { stop(); }
    Backend(const Backend&) = delete;
    Backend& operator=(const Backend&) = delete;

    void run(int workers, const std::function<void(int)>& body) {
        {
            const std::lock_guard lock(mutex);
            current = &body;
            busy = workers - 1;
            failure = nullptr;
            ++round;
        }
        wake.notify_all();
        call(body, 0);
        std::unique_lock lock(mutex);
        done.wait(lock, [this] { return busy == 0; });
        if (failure) std::rethrow_exception(failure);
    }

    void call(const std::function<void(int)>& body, int worker) {
        try {
            const FloatEnvironment environment;
            body(worker);
        } catch (...) {
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
        }
    }

    void stop() {
        {
            const std::lock_guard lock(mutex);
            stopping = true;
        }
        wake.notify_all();
        for (std::thread& thread : threads) thread.join();
    }

    void work(int worker) {
        std::uint64_t seen = 0;
        std::unique_lock lock(mutex);
        for (;;) {
            wake.wait(lock, [&] { return stopping || round != seen; });
            if (stopping) return;
            seen = round;
            const std::function<void(int)>& body = *current;
            lock.unlock();
            call(body, worker);
            lock.lock();
            if (--busy == 0) done.notify_all();
        }
    }

    std::mutex mutex;
    std::condition_variable wake;
    std::condition_variable done;
    const std::function<void(int)>* current = nullptr;
    std::exception_ptr failure;
    std::uint64_t round = 0;
    int busy = 0;
    bool stopping = false;
    std::vector<std::thread> threads;
};

#endif

WorkerPool::WorkerPool(int workers) : m_size(checked_size(workers)) {
    m_backend = std::make_unique<Backend>(m_size);
}
WorkerPool::~WorkerPool() = default;
WorkerPool::WorkerPool(WorkerPool&&) noexcept = default;
WorkerPool& WorkerPool::operator=(WorkerPool&&) noexcept = default;

void WorkerPool::run(const std::function<void(int)>& body) {
    if (m_account == nullptr) return run_workers(body);
    StageClock& first = m_account->clock(0);
    const StageClock::Place stage = first.place();
    run_workers([&](int worker) {
        if (worker > 0) {
            const ClockLoan loan(m_account->clock(worker), stage);
            body(worker);
        } else {
            body(0);
            first.enter(StageClock::place(FrameStage::waiting));  // for the others
        }
    });
    first.enter(stage);
}

void WorkerPool::run_workers(const std::function<void(int)>& body) {
    if (m_size == 1) {
        const FloatEnvironment environment;
        body(0);
        return;
    }
    m_backend->run(m_size, body);
}

void for_each_index(WorkerPool& pool, std::size_t count, std::size_t grain,
                    const std::function<void(std::size_t, int)>& body) {
    const auto workers = static_cast<std::size_t>(pool.size());
    std::vector<std::size_t> ends;
    for (std::size_t i = 1; i <= workers; ++i)
        ends.push_back(std::min(count, (count * i / workers + grain - 1) / grain * grain));
    hand_out(
        pool, 0, ends, [grain](std::size_t) { return grain; }, body, [] {});
}

void for_each_piece(WorkerPool& pool, const WorkOrder& order,
                    const std::function<void(std::size_t, int)>& body,
                    const std::function<void()>& at_end) {
    const std::size_t workers = order.ends.size();
    hand_out(
        pool, order.shared, order.ends,
        [workers](std::size_t left) { return handful(left, workers); },
        [&](std::size_t i, int worker) { body(order.pieces[i], worker); }, at_end);
}

}  // namespace burnish
