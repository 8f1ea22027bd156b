#pragma once

#include <functional>
#include <memory>

#include "core/work_order.hpp"

namespace burnish {

class FrameAccount;

/// A fixed number of workers. The backend is oneTBB, or plain threads (BURNISH_THREADS=std), which
/// the thread sanitizer can see through.
class WorkerPool {
  public:
    /// 0 = one per core, at most 1024. Throws Error{bad_option} outside 0 .. 1024.
    explicit WorkerPool(int workers);
    ~WorkerPool();
    WorkerPool(WorkerPool&&) noexcept;
    WorkerPool& operator=(WorkerPool&&) noexcept;

    [[nodiscard]] int size() const noexcept { return m_size; }

    /// Calls body(w) once for every worker number w, each on a thread of its own as far as the
    /// machine allows, all in the default floating-point environment; returns when all are done.
    /// An exception from a body is rethrown here (one of them, if there are several).
    void run(const std::function<void(int)>& body);

    /// From now on worker w runs with the clock of `account`, in the stage that worker 0 is in when
    /// `run` is called. Null: without.
    void keep_account(FrameAccount* account) { m_account = account; }

  private:
    void run_workers(const std::function<void(int)>& body);

    struct Backend;
    std::unique_ptr<Backend> m_backend;
    int m_size;
    FrameAccount* m_account = nullptr;
};

/// Hands out 0 .. count - 1 to the workers of `pool`, `grain` at a time: to each a part of its own
/// in increasing order, then what is left of the others'. Neighbours stay in one cache, and with
/// the same count the same ones in every frame (S1c at 1080p, two workers: 6.5 -> 5.3 ms).
/// body(index, worker).
void for_each_index(WorkerPool& pool, std::size_t count, std::size_t grain,
                    const std::function<void(std::size_t, int)>& body);

/// The same in the order given, which has a part for each worker of `pool`: body(piece, worker), of
/// parts a handful() at a time; then at_end() on the thread of each worker, unless a body threw.
void for_each_piece(WorkerPool& pool, const WorkOrder& order,
                    const std::function<void(std::size_t, int)>& body,
                    const std::function<void()>& at_end);

}  // namespace burnish
