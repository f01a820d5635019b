#include "runtime/system/worker_threads.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace graftal {

namespace {

/// The numbers that are still to be handed out, and what went wrong first.
class Round {
  public:
    Round(std::uint64_t count, const std::function<void(int, std::uint64_t)>& work)
        : count_(count), work_(work) {}

    void take_part(int worker) noexcept {
        try {
            for (std::uint64_t number = next_++; number < count_; number = next_++)
                work_(worker, number);
        } catch (...) {
            next_ = count_;
            const std::lock_guard lock(mutex_);
            if (!fault_) fault_ = std::current_exception();
        }
    }

    void rethrow() const {
        if (fault_) std::rethrow_exception(fault_);
    }

  private:
    const std::uint64_t count_;
    const std::function<void(int, std::uint64_t)>& work_;
    std::atomic<std::uint64_t> next_ = 0;
    std::mutex mutex_;
    std::exception_ptr fault_;
};

} // namespace

WorkerThreads::WorkerThreads(int wanted)
    : count_(wanted > 0 ? wanted : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()))) {}

int WorkerThreads::for_each(std::uint64_t count, const std::function<void(int, std::uint64_t)>& work) const {
    Round round(count, work);
    const auto useful = static_cast<int>(std::min<std::uint64_t>(static_cast<std::uint64_t>(count_), count));
    std::vector<std::thread> threads;
    threads.reserve(static_cast<std::size_t>(std::max(0, useful - 1)));
    try {
        while (static_cast<int>(threads.size()) + 1 < useful)
            threads.emplace_back(
                [&round, worker = static_cast<int>(threads.size()) + 1] { round.take_part(worker); });
    } catch (const std::exception&) { // of the system, or no memory for what belongs to a thread
    }
    round.take_part(0);
    for (std::thread& thread : threads)
        thread.join();
    round.rethrow();
    return static_cast<int>(threads.size()) + 1;
}

} // namespace graftal
