#include <algorithm>
#include <csignal>
#include <cstdint>
#include <exception>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "compiler/support/check.h"
#include "runtime/system/memory_limit.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/options.h"
#include "tools/graftal/report.h"

namespace {

/// What graftal has itself, however little POV-Ray may have: a cut for a small scene may take as much as one
/// for a large scene.
constexpr std::uint64_t least_memory_bytes = 2ull << 30;

/// A file that we open must never become a standard stream that the caller has closed: such a stream is
/// opened the wrong way round, so that its use still fails.
void occupy_standard_streams() {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
        if (::fcntl(stream, F_GETFD) < 0 &&
            ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) != stream)
            ::_exit(graftal::exit_environment);
}

} // namespace

int main(int argc, char** argv) {
    occupy_standard_streams();
    // A closed pipe and a file that may not grow are failed writes, and reported as such.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        const graftal::ParsedCommandLine parsed = graftal::parse_command_line(argc, argv);
        if (!parsed.options) return parsed.exit_status;
        graftal::limit_memory(std::max(parsed.options->compile.cut.memory_bytes, least_memory_bytes));
        return graftal::run_command(*parsed.options);
    } catch (const std::bad_alloc& fault) {
        return graftal::conclude_out_of_memory(fault);
    } catch (const graftal::BrokenInvariant& fault) {
        graftal::complain(fault.what());
    } catch (const std::exception& fault) {
        graftal::complain(std::string("internal error: ") + fault.what());
    }
    return graftal::exit_environment;
}
