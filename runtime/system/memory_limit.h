#pragma once

#include <cstdint>

namespace graftal {

/// From now on this process may have so much more memory than it has; asking for more than that throws
/// std::bad_alloc. The kernel counts (RLIMIT_DATA), so that nothing is left out and nothing is slower.
void limit_memory(std::uint64_t bytes);

/// The last value given to limit_memory(); 0: never called.
std::uint64_t memory_limit();

/// Gives a child the limit that this process had at first. Only system calls: for the time between fork and
/// exec.
void restore_memory_limit();

} // namespace graftal
