#pragma once

#include <cstdint>
#include <functional>

namespace graftal {

/// The door to parallel work: the core makes no threads. On a machine with an operating system WorkerThreads
/// (runtime/system) stands behind it; a browser has SerialWorkers.
class Workers {
  public:
    virtual ~Workers() = default;

    /// At least one: the thread that asks takes part.
    virtual int count() const = 0;

    /// Calls work(worker, number) once for each number below `count`; they are handed out from 0 on. Workers
    /// have numbers from 0 to count() - 1, each a thread of its own. After an exception no more numbers are
    /// handed out, and it is thrown again when all have stopped. Returns the number of threads that took
    /// part.
    virtual int for_each(std::uint64_t count,
                         const std::function<void(int worker, std::uint64_t number)>& work) const = 0;
};

/// The thread that asks, alone.
class SerialWorkers final : public Workers {
  public:
    int count() const override { return 1; }
    int for_each(std::uint64_t count,
                 const std::function<void(int worker, std::uint64_t number)>& work) const override {
        for (std::uint64_t number = 0; number < count; ++number)
            work(0, number);
        return 1;
    }
};

} // namespace graftal
