#include "runtime/system/memory_limit.h"

#include <cstdlib>
#include <memory>
#include <new>

#include <gtest/gtest.h>

namespace graftal {
namespace {

bool can_have(std::size_t bytes) {
    try {
        const auto memory = std::make_unique_for_overwrite<char[]>(bytes);
        return memory != nullptr;
    } catch (const std::bad_alloc&) {
        return false;
    }
}

TEST(MemoryLimit, GivesSoMuchAndNoMore) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "sanitizers end a program whose memory ends";
#endif
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto work = [] {
        const bool free = can_have(200u << 20);
        limit_memory(100u << 20);
        const bool kept = memory_limit() == 100u << 20 && can_have(90u << 20) && !can_have(1u << 30);
        limit_memory(400u << 20);
        const bool raised = can_have(390u << 20) && !can_have(2u << 30);
        restore_memory_limit();
        std::_Exit(free && kept && raised && can_have(2u << 30) ? 0 : 1);
    };
    EXPECT_EXIT(work(), testing::ExitedWithCode(0), "");
}

} // namespace
} // namespace graftal
