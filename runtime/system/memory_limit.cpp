#include "runtime/system/memory_limit.h"

#include <algorithm>
#include <optional>
#include <thread>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>

#include "runtime/system/process_memory.h"

namespace graftal {

namespace {

/// The process has one limit, and so one of each.
std::optional<rlimit> limit_at_first;
std::uint64_t bytes_given = 0;

} // namespace

void limit_memory(std::uint64_t bytes) {
    rlimit limit = {};
    if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
    if (!limit_at_first) limit_at_first = limit;
    constexpr std::uint64_t stack_bytes = 8u << 20; // reserved for each thread, and hardly used
    const std::uint64_t wanted = memory_of("self", "VmData:") + bytes +
                                 stack_bytes * std::max(1u, std::thread::hardware_concurrency());
#ifdef __GLIBC__
    // Large blocks go back to the kernel at once. Else holes that stages leave behind count against the
    // next: the cut of a wood took 2.0 GiB where it now takes 1.7.
    ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
    ::mallopt(M_TRIM_THRESHOLD, 1 << 20);
#endif
    limit.rlim_cur = std::min<rlim_t>(wanted, limit_at_first->rlim_cur);
    if (::setrlimit(RLIMIT_DATA, &limit) == 0) bytes_given = bytes;
}

std::uint64_t memory_limit() {
    return bytes_given;
}

void restore_memory_limit() {
    if (limit_at_first) ::setrlimit(RLIMIT_DATA, &*limit_at_first);
}

} // namespace graftal
