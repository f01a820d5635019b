#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace graftal {

/// The threads of one piece of parallel work: as many as were asked for, or fewer where the system has no
/// room for more. TBB itself would abort there.
class WorkerThreads {
  public:
    /// `wanted`: 0 for one a processor.
    explicit WorkerThreads(int wanted);

    /// At least one: the thread that asks takes part.
    int count() const { return count_; }

    /// Calls `work`, in which TBB's algorithms use these threads.
    template<typename Work> void run(const Work& work) { arena_.execute(work); }

  private:
    int count_;
    tbb::global_control limit_;
    tbb::task_arena arena_;
};

} // namespace graftal
