#include "runtime/povray/temporary_directory.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compiler/support/file.h"

namespace graftal {

namespace {

constexpr std::string_view prefix = "graftal-";
constexpr std::string_view unique = "XXXXXX";
/// Holds the files of each. What merely has such a name is somebody else's.
constexpr std::string_view inner = "graftal-scratch";

std::string parent_path() {
    const char* parent = std::getenv("TMPDIR");
    return parent && *parent ? parent : "/tmp";
}

std::string name_to_fill() {
    return fmt::format("{}/{}{}", parent_path(), prefix, unique);
}

/// Keeps others from taking a directory for abandoned before it is locked.
class Nursery {
  public:
    explicit Nursery(int how) : folder_(::open(parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        // Who keeps it for ever (it is everybody's) must not keep us waiting.
        for (int tries = 0; tries < 50 && !held_; ++tries) {
            held_ = folder_ >= 0 && ::flock(folder_, how | LOCK_NB) == 0;
            if (!held_ && how == LOCK_EX) return;
            if (!held_) ::usleep(10'000);
        }
    }
    ~Nursery() {
        if (folder_ >= 0) ::close(folder_);
    }
    Nursery(const Nursery&) = delete;
    Nursery& operator=(const Nursery&) = delete;
    bool held() const { return held_; }

  private:
    int folder_;
    bool held_ = false;
};

/// Ours by name, by owner and by what is in it.
bool may_be_abandoned(const std::filesystem::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    struct stat info = {};
    return name.size() == prefix.size() + unique.size() && name.starts_with(prefix) &&
           ::lstat(entry.path().c_str(), &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == ::geteuid() &&
           ::lstat((entry.path() / inner).c_str(), &info) == 0 && S_ISDIR(info.st_mode);
}

void remove_abandoned() {
    const Nursery nursery(LOCK_EX);
    if (!nursery.held()) return;
    std::error_code error, ignored;
    for (std::filesystem::directory_iterator entry(parent_path(), error), end; !error && entry != end;
         entry.increment(error)) {
        if (!may_be_abandoned(*entry)) continue;
        const int lock = lock_path(entry->path().string());
        if (lock < 0) continue; // its owner is at work
        std::filesystem::remove_all(entry->path(), ignored);
        ::close(lock);
    }
}

} // namespace

TemporaryDirectory::~TemporaryDirectory() {
    std::error_code ignored;
    if (!outer_.empty()) std::filesystem::remove_all(outer_, ignored);
    if (lock_ >= 0) ::close(lock_);
}

Status TemporaryDirectory::create() {
    remove_abandoned();
    const Nursery nursery(LOCK_SH);
    std::string path = name_to_fill();
    if (!::mkdtemp(path.data()))
        return Status::failure(
            fmt::format("cannot make a temporary directory '{}': {}", path, std::strerror(errno)));
    outer_ = path;
    lock_ = lock_path(path);
    path_ = fmt::format("{}/{}", path, inner);
    if (::mkdir(path_.c_str(), 0700) != 0)
        return Status::failure(
            fmt::format("cannot make a temporary directory '{}': {}", path_, std::strerror(errno)));
    return {};
}

std::FILE* open_temporary_file() {
    std::string path = name_to_fill();
    const int number = ::mkostemp(path.data(), O_CLOEXEC);
    if (number < 0) return nullptr;
    ::unlink(path.c_str());
    std::FILE* file = ::fdopen(number, "w+b");
    if (!file) ::close(number);
    return file;
}

} // namespace graftal
