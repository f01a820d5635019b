#include <algorithm>
#include <csignal>
#include <cstdint>
#include <exception>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

#include "compiler/support/check.h"
#include "runtime/image_files/image_files.h"
#include "runtime/system/file.h"
#include "runtime/system/memory_limit.h"
#include "runtime/system/signal_stack.h"
#include "runtime/system/temporary_directory.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/options.h"
#include "tools/graftal/report.h"

namespace {

/// Least memory of graftal itself, however little POV-Ray may have: a cut for a small scene may take as much
/// as one for a large scene.
constexpr std::uint64_t least_memory_bytes = 2ull << 30;

/// A file that we open must never become a standard stream that the caller has closed: such a stream is
/// opened the wrong way round, so that its use still fails.
void occupy_standard_streams() {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
        if (::fcntl(stream, F_GETFD) < 0 &&
            ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) != stream)
            ::_exit(graftal::exit_environment);
}

int run_command_line(int argc, char** argv) {
    try {
        const graftal::ParsedCommandLine parsed = graftal::parse_command_line(argc, argv);
        if (!parsed.options) return parsed.exit_status;
        graftal::limit_memory(
            std::max(parsed.options->render.compile.detail.memory_bytes, least_memory_bytes));
        return parsed.options->command->run(*parsed.options);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const graftal::BrokenInvariant& fault) {
        graftal::complain(fault.what());
    } catch (const std::exception& fault) {
        graftal::complain(std::string("internal error: ") + fault.what());
    }
    return graftal::exit_environment;
}

/// Takes away what is half done. Only calls that a handler may make.
[[noreturn]] void end_at_once(std::string_view text) {
    graftal::remove_pending_files();
    graftal::remove_temporary_directories();
    if (::write(STDERR_FILENO, text.data(), text.size()) < 0)
        ::_exit(graftal::exit_environment); // standard error is closed
    ::_exit(graftal::exit_environment);
}

/// Some libraries abort or crash where they get no memory or cannot open a file of the system's: of those
/// behind OpenImageIO some do while they are loaded, and GLib ends with a trap.
void end_after_crash(int) {
    end_at_once("graftal: internal error: graftal or one of its libraries crashed; the system may have no "
                "memory, files "
                "or threads left\n");
}

/// Others wait for ever where they get no thread (image.h).
void end_after_waiting() {
    end_at_once("graftal: a library does not load; the system may have no memory, files or threads left\n");
}

void handle_crashes() {
#ifdef __SANITIZE_ADDRESS__
    graftal::handle_on_own_stack({SIGABRT, SIGTRAP},
                                 end_after_crash); // the sanitizer tells more of the others
#else
    graftal::handle_on_own_stack({SIGABRT, SIGTRAP, SIGSEGV, SIGBUS}, end_after_crash);
#endif
    graftal::watch_libraries_load(end_after_waiting);
}

} // namespace

int main(int argc, char** argv) {
    occupy_standard_streams();
    // A closed pipe and a file that may not grow are failed writes, and reported as such.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    handle_crashes();
    // The memory may not even suffice to say what went wrong.
    try {
        return run_command_line(argc, argv);
    } catch (const std::bad_alloc& fault) {
        return graftal::conclude_out_of_memory(fault);
    }
}
