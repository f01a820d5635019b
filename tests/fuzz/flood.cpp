// flood TARGET SECONDS SEED FINDING FOLDER: changed inputs from a folder through a target of tests/fuzz, for
// so many seconds, without a look at coverage: many more than libFuzzer can run.
// Prints the executions, the slowest in milliseconds and what was found; the input then stands in the file
// FINDING, and the status is 1.

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include "runtime/system/signal_stack.h"
#include "tests/fuzz/fuzz_targets.h"

namespace {

using namespace graftal::fuzz;

constexpr std::size_t most_bytes = 2000;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int slower = 4; ///< a build with sanitizers, in time and in memory
#else
constexpr int slower = 1;
#endif
constexpr long most_kib = slower * 2'000'000;
constexpr int most_seconds = slower * 20; ///< for one input

/// What a signal handler may look at.
struct Now {
    const char* input = nullptr;
    std::size_t size = 0;
    const char* finding = nullptr;
    unsigned long long executions = 0;
    double slowest_ms = 0;
    int report = STDOUT_FILENO; ///< the targets have no standard output
};
Now now;

void write_all(int file, const char* bytes, std::size_t count) {
    while (count > 0) {
        const ssize_t written = ::write(file, bytes, count);
        if (written <= 0) return;
        bytes += written;
        count -= static_cast<std::size_t>(written);
    }
}

/// Only system calls and what formats into a buffer of our own.
void report(const char* what) {
    char text[400];
    const int size =
        std::snprintf(text, sizeof text, "executions %llu\nslowest_ms %.0f\n%s%s%s", now.executions,
                      now.slowest_ms, *what ? "found " : "", what, *what ? "\n" : "");
    write_all(now.report, text, std::min(static_cast<std::size_t>(size), sizeof text - 1));
}

[[noreturn]] void found(const char* what) {
    const int file = ::open(now.finding, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file >= 0) write_all(file, now.input, now.size);
    report(what);
    ::_exit(1);
}

extern "C" void on_signal(int signal) {
    found(signal == SIGPROF ? "time" : strsignal(signal));
}

void start_watch(int seconds) {
    const itimerval timer = {{0, 0}, {seconds, 0}};
    ::setitimer(ITIMER_PROF, &timer, nullptr);
}

double seconds_of(clockid_t clock) {
    timespec time = {};
    ::clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

long resident_kib() {
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

void try_one(const Target& target, const std::string& bytes) {
    now.input = bytes.data();
    now.size = bytes.size();
    const double begin = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    start_watch(most_seconds);
    try {
        target.run(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    } catch (const std::exception& fault) {
        found(fault.what());
    }
    start_watch(0);
    ++now.executions;
    now.slowest_ms = std::max(now.slowest_ms, 1e3 * (seconds_of(CLOCK_PROCESS_CPUTIME_ID) - begin));
    if (resident_kib() > most_kib) found("memory");
}

void silence() {
    now.report = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    const int null = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 6) {
        std::fputs("usage: flood TARGET SECONDS SEED FINDING FOLDER\n", stderr);
        return 2;
    }
    const double deadline = seconds_of(CLOCK_MONOTONIC) + std::atof(argv[2]);
    graftal::testing::Choices choices(std::strtoull(argv[3], nullptr, 10));
    now.finding = argv[4];
    const std::vector<Input> inputs = files_of(argv[5]);
    for (const Target& target : targets()) {
        if (target.name != argv[1] || inputs.empty()) continue;
        silence();
        graftal::handle_on_own_stack({SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF}, on_signal);
        SyntaxMutator mutator;
        while (seconds_of(CLOCK_MONOTONIC) < deadline)
            try_one(target, changed(target, inputs, most_bytes, mutator, choices));
        report("");
        return 0;
    }
    std::fputs("flood: there is no such target, or no input\n", stderr);
    return 2;
}
