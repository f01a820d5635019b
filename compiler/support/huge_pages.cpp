#include "compiler/support/huge_pages.h"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace graftal {

void prefer_huge_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t size_bytes) {
#ifdef MADV_HUGEPAGE
    constexpr std::size_t page_bytes = 1u << 21;
    if (size_bytes < 2 * page_bytes) return;
    // A hint: where it is refused, small pages do.
    const std::size_t before = -reinterpret_cast<std::uintptr_t>(begin) % page_bytes;
    madvise(static_cast<char*>(begin) + before, (size_bytes - before) / page_bytes * page_bytes, MADV_HUGEPAGE);
#endif
}

} // namespace graftal
