#include "runtime/system/files_below.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compiler/support/printable.h"

namespace graftal {

namespace {

class HeldDescriptor {
  public:
    explicit HeldDescriptor(int number) : number_(number) {}
    ~HeldDescriptor() {
        const int saved_errno = errno;
        if (number_ >= 0) ::close(number_);
        errno = saved_errno;
    }
    HeldDescriptor(const HeldDescriptor&) = delete;
    HeldDescriptor& operator=(const HeldDescriptor&) = delete;
    void replace(int number) {
        ::close(number_);
        number_ = number;
    }
    int number() const { return number_; }
    bool ok() const { return number_ >= 0; }
    int release() { return std::exchange(number_, -1); }

  private:
    int number_;
};

Status failure(const std::string& folder, std::string_view name, int reason) {
    const std::string text = reason == EPERM
                                 ? "it is no regular file in a folder of its own: graftal follows no "
                                   "links, pipes and devices in a job's folder"
                                 : std::strerror(reason);
    return Status::failure(fmt::format("cannot use '{}/{}': {}", folder, name, text));
}

} // namespace

bool is_name_below(std::string_view name) {
    if (!is_printable(name)) return false;
    while (true) {
        const std::size_t slash = name.find('/');
        const std::string_view part = name.substr(0, slash);
        if (part.empty() || part == "." || part == "..") return false;
        if (slash == std::string_view::npos) return true;
        name.remove_prefix(slash + 1);
    }
}

/// EPERM stands for what is there and is refused.
int open_below(const std::string& folder, std::string_view name, int flags) {
    constexpr int plain = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY;
    if (!is_name_below(name)) {
        errno = EPERM;
        return -1;
    }
    HeldDescriptor at(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!at.ok()) return -1;
    for (std::size_t slash = 0; (slash = name.find('/')) != std::string_view::npos;
         name.remove_prefix(slash + 1)) {
        const std::string part(name.substr(0, slash));
        const int below = ::openat(at.number(), part.c_str(), O_RDONLY | O_DIRECTORY | plain);
        if (below < 0 && (errno == ELOOP || errno == ENOTDIR)) errno = EPERM;
        if (below < 0) return -1;
        at.replace(below);
    }
    const std::string last(name);
    // A device may act as soon as it is opened: look first. A file that comes between is looked at again.
    struct stat info = {};
    if (::fstatat(at.number(), last.c_str(), &info, AT_SYMLINK_NOFOLLOW) == 0 && !S_ISREG(info.st_mode)) {
        errno = EPERM;
        return -1;
    }
    HeldDescriptor file(::openat(at.number(), last.c_str(), flags | plain, S_IRUSR | S_IWUSR));
    if (!file.ok()) return -1;
    if (::fstat(file.number(), &info) == 0 && S_ISREG(info.st_mode)) return file.release();
    errno = EPERM;
    return -1;
}

std::optional<std::uint64_t> bytes_below(const std::string& folder, std::string_view name) {
    const HeldDescriptor file(open_below(folder, name));
    struct stat info = {};
    if (!file.ok() || ::fstat(file.number(), &info) != 0) return std::nullopt;
    return static_cast<std::uint64_t>(info.st_size);
}

Status read_below(const std::string& folder, std::string_view name, std::string& text,
                  std::uint64_t most_bytes) {
    const HeldDescriptor file(open_below(folder, name));
    struct stat info = {};
    if (!file.ok() || ::fstat(file.number(), &info) != 0) return failure(folder, name, errno);
    const auto bytes = static_cast<std::uint64_t>(info.st_size);
    if (bytes > most_bytes)
        return Status::failure(
            fmt::format("'{}/{}' is too long: more than {} bytes", folder, name, most_bytes));
    text.resize(bytes);
    std::size_t done = 0;
    while (done < text.size()) {
        const ssize_t count = ::read(file.number(), text.data() + done, text.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return failure(folder, name, errno);
        if (count == 0) break; // the file has become shorter
        done += static_cast<std::size_t>(count);
    }
    text.resize(done);
    return {};
}

Status check_below(const std::string& folder, std::string_view name) {
    const HeldDescriptor file(open_below(folder, name, O_RDONLY));
    if (file.ok()) return {};
    // A file that is not there may be made where its folder is.
    const int reason = errno;
    const std::size_t slash = name.rfind('/');
    struct stat info = {};
    const std::string above =
        slash == std::string_view::npos ? folder : fmt::format("{}/{}", folder, name.substr(0, slash));
    if (reason == ENOENT && ::stat(above.c_str(), &info) == 0 && S_ISDIR(info.st_mode)) return {};
    return failure(folder, name, reason);
}

} // namespace graftal
