#include "runtime/system/memory_limit.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include <sys/resource.h>

namespace graftal {

namespace {

/// The process has one limit, and so one of each.
std::optional<rlimit> limit_at_first;
std::uint64_t bytes_given = 0;

/// What counts against the limit already: the figure behind "VmData:", in kB.
std::uint64_t data_bytes() {
    std::ifstream file("/proc/self/status");
    std::uint64_t kilobytes = 0;
    for (std::string word; file >> word;)
        if (word == "VmData:") {
            file >> kilobytes;
            break;
        }
    return kilobytes << 10;
}

} // namespace

void limit_memory(std::uint64_t bytes) {
    rlimit limit = {};
    if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
    if (!limit_at_first) limit_at_first = limit;
    constexpr std::uint64_t stack_bytes = 8u << 20; // reserved for each thread, and hardly used
    const std::uint64_t wanted = data_bytes() + std::max(bytes, least_memory_bytes) +
                                 stack_bytes * std::max(1u, std::thread::hardware_concurrency());
    limit.rlim_cur = std::min<rlim_t>(wanted, limit_at_first->rlim_cur);
    if (::setrlimit(RLIMIT_DATA, &limit) == 0) bytes_given = std::max(bytes, least_memory_bytes);
}

std::uint64_t memory_limit() {
    return bytes_given;
}

void restore_memory_limit() {
    if (limit_at_first) ::setrlimit(RLIMIT_DATA, &*limit_at_first);
}

} // namespace graftal
