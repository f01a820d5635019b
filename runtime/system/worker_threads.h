#pragma once

#include "compiler/support/workers.h"

namespace graftal {

/// The threads of one piece of parallel work: the number that is asked for, or fewer where the system has no
/// room for more. oneTBB would not do: it aborts where a thread cannot be made, and waits for ever where its
/// own memory runs out.
class WorkerThreads final : public Workers {
  public:
    /// `wanted`: 0 for one a processor.
    explicit WorkerThreads(int wanted);

    int count() const override { return count_; }
    int for_each(std::uint64_t count,
                 const std::function<void(int worker, std::uint64_t number)>& work) const override;

  private:
    int count_;
};

} // namespace graftal
