#include "runtime/system/confinement.h"

#include <algorithm>
#include <string_view>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace graftal {

namespace {

// Landlock as the kernel has it (linux/landlock.h), here so that a build does not depend on how new its
// headers are.
constexpr long create_ruleset = 444, add_rule = 445, restrict_self = 446;
constexpr std::uint32_t ask_version = 1;
constexpr int path_beneath = 1;

constexpr std::uint64_t execute = 1 << 0, write_file = 1 << 1, read_file = 1 << 2, read_folder = 1 << 3,
                        rename_across = 1 << 13, truncate_file = 1 << 14, use_device = 1 << 15;
constexpr std::uint64_t of_first_version = (1 << 13) - 1;
/// Rights that a rule about a file, not a folder, may grant.
constexpr std::uint64_t of_files = execute | write_file | read_file | truncate_file | use_device;
constexpr std::uint64_t reading = execute | read_file | read_folder;
constexpr std::uint64_t no_tcp = 3; ///< neither bind nor connect

struct Ruleset {
    std::uint64_t files, network, scope;
};

struct __attribute__((packed)) PathRule {
    std::uint64_t rights;
    std::int32_t descriptor;
};

/// 0: none.
int landlock_version() {
    const long version = ::syscall(create_ruleset, nullptr, 0, ask_version);
    return version > 0 ? static_cast<int>(version) : 0;
}

std::uint64_t file_rights(int version) {
    std::uint64_t rights = of_first_version;
    if (version >= 2) rights |= rename_across;
    if (version >= 3) rights |= truncate_file;
    if (version >= 5) rights |= use_device;
    return rights;
}

bool limit(int what, std::uint64_t most) {
    rlimit now = {};
    if (::getrlimit(static_cast<__rlimit_resource>(what), &now) != 0) return false;
    now.rlim_cur = std::min<rlim_t>(most, now.rlim_max);
    // The soft limit of processor time is a signal that says why, and the hard one the end.
    now.rlim_max = what == RLIMIT_CPU ? std::min<rlim_t>(most + 5, now.rlim_max) : now.rlim_cur;
    return ::setrlimit(static_cast<__rlimit_resource>(what), &now) == 0;
}

/// The folders of programs and libraries, and the devices without contents. None holds anything of a user's.
constexpr std::string_view system_files[] = {
    "/bin",
    "/lib",
    "/lib32",
    "/lib64",
    "/usr/bin",
    "/usr/lib",
    "/usr/lib32",
    "/usr/lib64",
    "/usr/libexec",
    "/usr/local/bin",
    "/usr/local/lib",
    "/etc/ld.so.cache",
    "/dev/null",
    "/dev/zero",
    "/dev/random",
    "/dev/urandom",
    "/usr/share/zoneinfo",
    "/etc/localtime",
    "/sys/devices/system/cpu",
};

std::string folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? "." : path.substr(0, slash + 1);
}

} // namespace

bool can_confine_files() {
    return landlock_version() > 0;
}

PreparedConfinement::PreparedConfinement(const Confinement& confinement, const std::string& program)
    : confinement_(confinement) {
    const int version = landlock_version();
    if (version == 0) return;
    handled_ = file_rights(version);
    const Ruleset set = {handled_, no_tcp, 0};
    const std::size_t size = version >= 4 ? 2 * sizeof(std::uint64_t) : sizeof(std::uint64_t);
    rules_ = static_cast<int>(::syscall(create_ruleset, &set, size, 0));
    if (rules_ < 0) return;
    ::fcntl(rules_, F_SETFD, FD_CLOEXEC);
    for (const std::string_view path : system_files)
        allow(std::string(path), path.starts_with("/dev/") ? reading | write_file : reading);
    // A program brings files of its own along, and scripts those that they run.
    allow(folder_of(program), reading);
    for (const std::string& path : confinement.readable)
        allow(path, reading);
    for (const std::string& path : confinement.writable)
        allow(path, handled_);
}

PreparedConfinement::~PreparedConfinement() {
    if (rules_ >= 0) ::close(rules_);
}

void PreparedConfinement::allow(const std::string& path, std::uint64_t rights) {
    const int descriptor = ::open(path.c_str(), O_PATH | O_CLOEXEC);
    struct stat info = {};
    if (descriptor < 0) return;
    if (::fstat(descriptor, &info) == 0) {
        if (!S_ISDIR(info.st_mode)) rights &= of_files;
        const PathRule rule = {rights & handled_, descriptor};
        ::syscall(add_rule, rules_, path_beneath, &rule, 0);
    }
    ::close(descriptor);
}

bool PreparedConfinement::apply() const {
    bool good = limit(RLIMIT_CORE, 0);
    if (confinement_.memory_bytes > 0) good = good && limit(RLIMIT_DATA, confinement_.memory_bytes);
    if (confinement_.file_bytes > 0) good = good && limit(RLIMIT_FSIZE, confinement_.file_bytes);
    if (confinement_.cpu_seconds > 0) good = good && limit(RLIMIT_CPU, confinement_.cpu_seconds);
    if (rules_ < 0) return good;
    return good && ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::syscall(restrict_self, rules_, 0) == 0;
}

} // namespace graftal
