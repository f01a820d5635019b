#include "runtime/system/signal_stack.h"

#include <csignal>

namespace graftal {

void handle_on_own_stack(std::initializer_list<int> signals, void (*handler)(int)) {
    static char stack[1 << 16];
    stack_t place = {};
    place.ss_sp = stack;
    place.ss_size = sizeof stack;
    ::sigaltstack(&place, nullptr);
    struct sigaction action = {};
    action.sa_handler = handler;
    action.sa_flags = SA_ONSTACK;
    ::sigemptyset(&action.sa_mask);
    for (const int signal : signals)
        ::sigaction(signal, &action, nullptr);
}

} // namespace graftal
