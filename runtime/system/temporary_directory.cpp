#include "runtime/system/temporary_directory.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <utility>

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "runtime/system/file.h"
#include "runtime/system/signal_registry.h"

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
        // Another user who keeps the lock for ever (everybody may) must not keep us waiting.
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

/// One pass over what an open folder holds. Takes no memory, and descriptors only for folders in it. True if
/// it came to the end and there was nothing.
bool remove_once(int folder) noexcept;

/// Removes what an open folder holds.
void empty_folder(int folder) noexcept {
    constexpr int most_passes = 100; // removed files may hide those that come after
    for (int pass = 0; pass < most_passes && !remove_once(folder); ++pass)
        ::lseek(folder, 0, SEEK_SET);
}

bool remove_once(int folder) noexcept {
    bool nothing = true;
    alignas(dirent64) char buffer[1 << 12];
    while (true) {
        const ssize_t count = ::getdents64(folder, buffer, sizeof buffer);
        if (count <= 0) return count == 0 && nothing;
        for (ssize_t at = 0; at < count;) {
            const auto& entry = *reinterpret_cast<const dirent64*>(buffer + at);
            at += entry.d_reclen;
            const std::string_view name = entry.d_name;
            if (name == "." || name == "..") continue;
            nothing = false;
            if (::unlinkat(folder, entry.d_name, 0) == 0) continue;
            const int inside =
                ::openat(folder, entry.d_name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
            if (inside < 0) continue;
            empty_folder(inside);
            ::close(inside);
            ::unlinkat(folder, entry.d_name, AT_REMOVEDIR);
        }
    }
}

/// All directories that there are, for handlers of signals. One that finds no place is left to the next run.
SignalRegistry<TemporaryDirectory, 16> directories;

} // namespace

void TemporaryDirectory::remove() const noexcept {
    if (outer_.empty()) return;
    if (folder_ >= 0) empty_folder(folder_);
    ::rmdir(path_.c_str());
    ::rmdir(outer_.c_str());
}

void remove_temporary_directories() noexcept {
    directories.for_each([](const TemporaryDirectory* directory) { directory->remove(); });
}

TemporaryDirectory::~TemporaryDirectory() {
    directories.forget(this);
    remove();
    for (const int file : {folder_, lock_})
        if (file >= 0) ::close(file);
}

Status TemporaryDirectory::create() {
    remove_abandoned();
    const Nursery nursery(LOCK_SH);
    std::string path = name_to_fill();
    if (!::mkdtemp(path.data())) return system_failure("make a temporary directory", path);
    outer_ = std::move(path);
    lock_ = lock_path(outer_);
    path_ = fmt::format("{}/{}", outer_, inner);
    if (::mkdir(path_.c_str(), 0700) == 0)
        folder_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder_ < 0) return system_failure("make a temporary directory", path_);
    directories.note(this);
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
