#include "runtime/system/process.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "runtime/system/file.h"
#include "runtime/system/memory_limit.h"
#include "runtime/system/process_memory.h"

extern char** environ;

namespace graftal {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

bool is_executable_file(const std::string& path) {
    struct stat info = {};
    return ::stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode) && ::access(path.c_str(), X_OK) == 0;
}

/// argv and envp for execve, made before fork: after it only system calls are safe.
class ExecTables {
  public:
    explicit ExecTables(const ProcessOptions& options) {
        for (char** entry = environ; *entry; ++entry)
            if (is_passed_on(*entry, options)) variables_.emplace_back(*entry);
        for (const auto& [name, value] : options.environment)
            variables_.push_back(name + "=" + value);
        for (const std::string& argument : options.arguments)
            argv_.push_back(const_cast<char*>(argument.c_str()));
        argv_.push_back(nullptr);
        for (const std::string& variable : variables_)
            envp_.push_back(const_cast<char*>(variable.c_str()));
        envp_.push_back(nullptr);
    }
    char* const* argv() const { return argv_.data(); }
    char* const* envp() const { return envp_.data(); }

  private:
    static bool is_passed_on(std::string_view entry, const ProcessOptions& options) {
        const std::string_view own = entry.substr(0, entry.find('='));
        for (const auto& [name, value] : options.environment)
            if (own == name) return false;
        return !options.clean_environment || own == "PATH" || own == "LD_LIBRARY_PATH";
    }

    std::vector<std::string> variables_;
    std::vector<char*> argv_;
    std::vector<char*> envp_;
};

/// The child's side of fork. Its failure reaches the parent as errno through `report`, which closes on exec.
[[noreturn]] void become_program(const char* program, const ProcessOptions& options, const ExecTables& tables,
                                 const PreparedConfinement* confinement, int null_device, int error_text,
                                 int report, pid_t parent) {
    // A group of its own: Ctrl-C at the terminal reaches us alone, and we pass it on once.
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    restore_memory_limit();
    bool ready = ::getppid() == parent;
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ})
        std::signal(number, SIG_DFL);
    ready = ready && (options.directory.empty() || ::chdir(options.directory.c_str()) == 0);
    const int output = options.output_with_errors ? error_text : null_device;
    ready = ready && ::dup2(null_device, STDIN_FILENO) >= 0 && ::dup2(output, STDOUT_FILENO) >= 0 &&
            ::dup2(error_text, STDERR_FILENO) >= 0;
    ready = ready && (!confinement || confinement->apply());
    if (ready) ::execve(program, tables.argv(), tables.envp());
    const int reason = errno;
    if (::write(report, &reason, sizeof reason) < 0) ::_exit(126);
    ::_exit(127);
}

class Descriptor {
  public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor() { reset(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return number_; }
    void reset(int number = -1) {
        if (number_ >= 0) ::close(number_);
        number_ = number;
    }

  private:
    int number_;
};

bool open_pipe(Descriptor& read_end, Descriptor& write_end) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return false;
    read_end.reset(ends[0]);
    write_end.reset(ends[1]);
    return true;
}

/// Passes the child's text on, and ends it where it is cancelled.
class Watch {
  public:
    Watch(pid_t child, int text, const ProcessOptions& options)
        : child_(child), text_(text), options_(options) {}

    /// False, with errno, if the child cannot be waited for.
    bool run(int& wait_status, rusage& usage) {
        while (true) {
            // A child without standard error, or one that we are ending, is looked at every 20 ms; any other
            // now and then, for its memory.
            pollfd watched[2] = {{text_, POLLIN, 0},
                                 {cancelled_ ? -1 : options_.cancel.wake_descriptor(), POLLIN, 0}};
            const bool waiting_for_text = text_ >= 0 && !cancelled_;
            const int ready = ::poll(watched, 2, waiting_for_text ? next_look_ms() : 20);
            heed_flag();
            note_memory();
            if (ready > 0 && watched[0].revents) pass_text();
            siginfo_t ended = {};
            if (::waitid(P_PID, static_cast<id_t>(child_), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 &&
                errno != EINTR)
                return give_up(wait_status, usage);
            if (ended.si_pid == child_) return take_leave(wait_status, usage);
        }
    }
    bool cancelled() const { return cancelled_; }
    /// The child's resident memory at its highest, as seen when it was last looked at.
    std::uint64_t peak_bytes() const { return peak_bytes_; }

  private:
    /// Ends all that the child has started: it must not outlive us, nor keep us waiting by holding standard
    /// error. The group is the child's own until it is waited for.
    bool take_leave(int& wait_status, rusage& usage) {
        ::kill(-child_, SIGKILL);
        pollfd text = {text_, POLLIN, 0};
        constexpr int most_pieces = 1 << 10; // many times more than a pipe may still hold
        for (int i = 0; i < most_pieces && text_ >= 0 && ::poll(&text, 1, 0) > 0; ++i)
            pass_text();
        pid_t ended = 0;
        while ((ended = ::wait4(child_, &wait_status, 0, &usage)) < 0 && errno == EINTR) {
        }
        return ended == child_;
    }

    /// A child that cannot be watched must not go on.
    bool give_up(int& wait_status, rusage& usage) {
        const int reason = errno;
        take_leave(wait_status, usage);
        errno = reason;
        return false;
    }

    void heed_flag() {
        if (!cancelled_ && options_.cancel.raised()) {
            cancelled_ = true;
            cancelled_at_ = Clock::now();
            ::kill(-child_, SIGTERM);
        }
        if (cancelled_ && !killed_ && seconds_since(cancelled_at_) > options_.grace_seconds) {
            killed_ = true;
            ::kill(-child_, SIGKILL);
        }
    }

    void note_memory() { peak_bytes_ = std::max(peak_bytes_, memory_of(std::to_string(child_), "VmHWM:")); }

    /// Often at first: most children are gone soon, and take their figures with them.
    int next_look_ms() {
        constexpr int seldom = 200;
        return look_ms_ = std::min(2 * look_ms_, seldom);
    }

    void pass_text() {
        char buffer[1 << 14];
        const ssize_t count = ::read(text_, buffer, sizeof buffer);
        if (count == 0 || (count < 0 && errno != EINTR)) text_ = -1;
        if (count > 0 && options_.on_error_text)
            options_.on_error_text(std::string_view(buffer, static_cast<std::size_t>(count)));
    }

    pid_t child_;
    int text_;
    const ProcessOptions& options_;
    bool cancelled_ = false;
    bool killed_ = false;
    int look_ms_ = 1;
    std::uint64_t peak_bytes_ = 0;
    Clock::time_point cancelled_at_;
};

void record_end(int wait_status, ProcessResult& result) {
    if (WIFEXITED(wait_status)) result.exit_code = WEXITSTATUS(wait_status);
    if (WIFSIGNALED(wait_status)) {
        result.exit_code = -1;
        result.signal = WTERMSIG(wait_status);
    }
}

} // namespace

std::optional<std::string> find_program(const std::string& name) {
    if (name.find('/') != std::string::npos)
        return is_executable_file(name) ? std::optional(name) : std::nullopt;
    const char* path = std::getenv("PATH");
    std::string_view rest = path ? path : "/usr/local/bin:/usr/bin:/bin";
    while (true) {
        const std::size_t colon = rest.find(':');
        const std::string folder(rest.substr(0, colon));
        const std::string candidate = (folder.empty() ? "." : folder) + "/" + name;
        if (is_executable_file(candidate)) return candidate;
        if (colon == std::string_view::npos) return std::nullopt;
        rest.remove_prefix(colon + 1);
    }
}

ProcessResult run_process(const ProcessOptions& options) {
    ProcessResult result;
    const std::string& name = options.arguments.front();
    const auto fail = [&](Status status) {
        result.status = std::move(status);
        return result;
    };
    std::optional<std::string> program = find_program(name);
    if (!program) return fail(Status::failure(fmt::format("cannot find the program '{}'", name)));
    // The child changes its directory before it looks for the program.
    if (char* absolute = ::realpath(program->c_str(), nullptr)) {
        program = absolute;
        std::free(absolute);
    }

    const Descriptor null_device(::open("/dev/null", O_RDWR | O_CLOEXEC));
    Descriptor text_in, text_out, report_in, report_out;
    if (null_device.get() < 0 || !open_pipe(text_in, text_out) || !open_pipe(report_in, report_out))
        return fail(Status::failure(fmt::format("cannot open a pipe: {}", std::strerror(errno))));
    const ExecTables tables(options);
    std::optional<PreparedConfinement> confinement;
    if (options.confinement) confinement.emplace(*options.confinement, *program);
    const std::uint64_t own_bytes = memory_of("self", "VmRSS:");
    const Clock::time_point start = Clock::now();
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child < 0) return fail(system_failure("start", name));
    if (child == 0)
        become_program(program->c_str(), options, tables, confinement ? &*confinement : nullptr,
                       null_device.get(), text_out.get(), report_out.get(), parent);
    text_out.reset();
    report_out.reset();

    int start_error = 0;
    while (::read(report_in.get(), &start_error, sizeof start_error) < 0 && errno == EINTR) {
    }
    Watch watch(child, start_error == 0 ? text_in.get() : -1, options);
    int wait_status = 0;
    rusage usage = {};
    if (!watch.run(wait_status, usage)) return fail(system_failure("wait for", name));
    if (start_error != 0) return fail(system_failure("start", name, start_error));
    result.cancelled = watch.cancelled();
    result.wall_seconds = seconds_since(start);
    record_end(wait_status, result);
    // The kernel's figure starts from what the child was before exec: a copy of us.
    const std::uint64_t peak_since_fork = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    constexpr std::uint64_t slack = 4 << 20;
    result.peak_bytes = peak_since_fork > own_bytes + slack ? peak_since_fork : watch.peak_bytes();
    return result;
}

} // namespace graftal
