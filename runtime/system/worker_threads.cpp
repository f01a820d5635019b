#include "runtime/system/worker_threads.h"

#include <algorithm>
#include <latch>
#include <system_error>
#include <thread>
#include <vector>

#include <tbb/info.h>

namespace graftal {

namespace {

/// How many of so many threads can live at once, this one included.
int possible_threads(int wanted) {
    std::latch go(1);
    std::vector<std::thread> threads;
    threads.reserve(static_cast<std::size_t>(wanted));
    bool room = true;
    while (room && static_cast<int>(threads.size()) + 1 < wanted)
        try {
            threads.emplace_back([&go] { go.wait(); });
        } catch (const std::system_error&) {
            room = false;
        }
    go.count_down();
    for (std::thread& thread : threads)
        thread.join();
    const int possible = static_cast<int>(threads.size()) + 1;
    return room ? possible : std::max(1, possible / 2); // the work itself needs some room too
}

} // namespace

WorkerThreads::WorkerThreads(int wanted)
    : count_(possible_threads(wanted > 0 ? wanted : tbb::info::default_concurrency())),
      limit_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count_)), arena_(count_) {
}

} // namespace graftal
