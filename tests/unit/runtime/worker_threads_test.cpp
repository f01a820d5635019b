#include "runtime/system/worker_threads.h"

#include <atomic>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <tbb/parallel_for.h>

namespace graftal {
namespace {

int sum_by(WorkerThreads& threads) {
    std::atomic<int> sum = 0;
    threads.run([&] { tbb::parallel_for(0, 1000, [&](int i) { sum += i; }); });
    return sum;
}

TEST(WorkerThreads, AreAsManyAsWereAskedFor) {
    for (const int wanted : {1, 2, 5}) {
        WorkerThreads threads(wanted);
        EXPECT_EQ(threads.count(), wanted);
        EXPECT_EQ(sum_by(threads), 499500);
    }
    EXPECT_GE(WorkerThreads(0).count(), 1);
}

/// A thread takes 8 MiB of address space for its stack.
TEST(WorkerThreads, AreFewerWhereThereIsNoRoom) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto work_in = [](rlim_t more_bytes) {
        std::ifstream file("/proc/self/statm");
        rlim_t pages = 0;
        file >> pages;
        const rlim_t bytes = pages * 4096 + more_bytes;
        const rlimit limit{bytes, bytes};
        if (::setrlimit(RLIMIT_AS, &limit) != 0) std::_Exit(2);
        WorkerThreads threads(200);
        std::_Exit(threads.count() < 200 && sum_by(threads) == 499500 ? 0 : 1);
    };
    for (const rlim_t megabytes : {12, 40, 200})
        EXPECT_EXIT(work_in(megabytes << 20), testing::ExitedWithCode(0), "") << megabytes;
}

} // namespace
} // namespace graftal
