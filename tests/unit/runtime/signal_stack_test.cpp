#include "runtime/system/signal_stack.h"

#include <csignal>

#include <gtest/gtest.h>
#include <unistd.h>

namespace graftal {
namespace {

void end_where_the_stack_is(int) {
    stack_t current = {};
    ::sigaltstack(nullptr, &current);
    ::_exit(current.ss_flags & SS_ONSTACK ? 7 : 8);
}

volatile bool goes_on = true;

/// Takes the whole stack.
int descend(int depth) {
    volatile char some[1 << 12];
    some[0] = static_cast<char>(depth);
    if (!goes_on) return 0;
    return descend(depth + 1) + some[0];
}

TEST(SignalStackDeathTest, AHandlerRunsWhereTheThreadHasNoStackLeft) {
    const auto run_out = [] {
        handle_on_own_stack({SIGSEGV, SIGBUS}, end_where_the_stack_is);
        ::_exit(descend(0));
    };
    EXPECT_EXIT(run_out(), ::testing::ExitedWithCode(7), "");
}

TEST(SignalStackDeathTest, EverySignalOfTheListIsHandled) {
    for (const int number : {SIGABRT, SIGUSR1, SIGUSR2}) {
        const auto raise = [&] {
            handle_on_own_stack({SIGABRT, SIGUSR1, SIGUSR2}, end_where_the_stack_is);
            std::raise(number);
        };
        EXPECT_EXIT(raise(), ::testing::ExitedWithCode(7), "") << number;
    }
}

} // namespace
} // namespace graftal
