#pragma once

#include <cstdint>
#include <functional>

namespace graftal {

/// The threads of one piece of parallel work: as many as were asked for, or fewer where the system has no
/// room for more. oneTBB would not do: it aborts where a thread cannot be made, and waits for ever where its
/// own memory runs out.
class WorkerThreads {
  public:
    /// `wanted`: 0 for one a processor.
    explicit WorkerThreads(int wanted);

    /// At least one: the thread that asks takes part.
    int count() const { return count_; }

    /// Calls work(worker, number) once for each number below `count`; they are handed out from 0 on. Workers
    /// have numbers from 0 on, each a thread of its own. After an exception no more numbers are handed out,
    /// and it is thrown again when all have stopped. Returns how many threads took part.
    int for_each(std::uint64_t count,
                 const std::function<void(int worker, std::uint64_t number)>& work) const;

  private:
    int count_;
};

} // namespace graftal
