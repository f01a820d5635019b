#include "runtime/system/worker_threads.h"

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace graftal {
namespace {

TEST(WorkerThreads, DoEachPieceOnce) {
    for (const int wanted : {1, 2, 5})
        for (const std::uint64_t count : {0, 1, 3, 1000}) {
            const WorkerThreads threads(wanted);
            EXPECT_EQ(threads.count(), wanted);
            std::vector<std::atomic<int>> times(count);
            std::atomic<bool> in_range = true;
            threads.for_each(count, [&](int worker, std::uint64_t number) {
                ++times[number];
                if (worker < 0 || worker >= wanted) in_range = false;
            });
            EXPECT_TRUE(in_range);
            for (const std::atomic<int>& time : times)
                EXPECT_EQ(time, 1);
        }
    EXPECT_GE(WorkerThreads(0).count(), 1);
}

TEST(WorkerThreads, HandPiecesOutInOrder) {
    std::vector<std::uint64_t> numbers;
    WorkerThreads(1).for_each(4, [&](int, std::uint64_t number) { numbers.push_back(number); });
    EXPECT_EQ(numbers, (std::vector<std::uint64_t>{0, 1, 2, 3}));
}

TEST(WorkerThreads, PassOnWhatIsThrownWhenAllHaveStopped) {
    for (const int wanted : {1, 4}) {
        std::atomic<int> begun = 0, ended = 0;
        const auto work = [&](int, std::uint64_t number) {
            ++begun;
            if (number == 10) {
                ++ended;
                throw std::runtime_error("ten");
            }
            ++ended;
        };
        EXPECT_THROW(WorkerThreads(wanted).for_each(1'000'000'000, work), std::runtime_error);
        EXPECT_EQ(begun, ended);
    }
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
        std::atomic<std::uint64_t> sum = 0;
        const int took_part =
            WorkerThreads(200).for_each(1000, [&](int, std::uint64_t number) { sum += number; });
        std::_Exit(took_part < 200 && sum == 499500 ? 0 : 1);
    };
    for (const rlim_t megabytes : {12, 40, 200})
        EXPECT_EXIT(work_in(megabytes << 20), testing::ExitedWithCode(0), "") << megabytes;
}

} // namespace
} // namespace graftal
