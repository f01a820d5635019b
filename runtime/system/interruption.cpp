#include "runtime/system/interruption.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>

#include <fcntl.h>
#include <unistd.h>

namespace graftal {

namespace {

constexpr std::array caught_signals = {SIGINT, SIGTERM, SIGHUP};

/// Read by all threads that draw.
std::atomic<int> last_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a handler may only touch such");
volatile std::sig_atomic_t wake_write = -1;
int wake_read = -1;
int depth = 0;
std::array<struct sigaction, caught_signals.size()> previous;

void remember(int number) {
    const int saved_errno = errno;
    last_signal = number;
    const char byte = 0;
    if (wake_write >= 0 && ::write(wake_write, &byte, 1) < 0) errno = saved_errno;
    errno = saved_errno;
}

} // namespace

Interruption::Interruption() {
    if (depth++ > 0) return;
    last_signal = 0;
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC | O_NONBLOCK) == 0) {
        wake_read = ends[0];
        wake_write = ends[1];
    }
    struct sigaction action = {};
    action.sa_handler = remember;
    ::sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < caught_signals.size(); ++i) {
        ::sigaction(caught_signals[i], nullptr, &previous[i]);
        // Signals that were ignored on purpose (nohup) stay ignored.
        if (previous[i].sa_handler != SIG_IGN) ::sigaction(caught_signals[i], &action, nullptr);
    }
}

Interruption::~Interruption() {
    if (--depth > 0) return;
    for (std::size_t i = 0; i < caught_signals.size(); ++i)
        ::sigaction(caught_signals[i], &previous[i], nullptr);
    const int write_end = wake_write;
    wake_write = -1;
    if (wake_read >= 0) {
        ::close(wake_read);
        ::close(write_end);
    }
    wake_read = -1;
}

int Interruption::signal() const {
    return last_signal;
}

CancelFlag Interruption::flag() const {
    return CancelFlag([] { return last_signal != 0; }, wake_read);
}

} // namespace graftal
