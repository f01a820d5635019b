#include "runtime/system/file_watch.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

namespace graftal {

namespace {

namespace fs = std::filesystem;

/// The kernel's own limit.
constexpr int most_links = 40;

constexpr std::uint32_t of_folder = IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR | IN_MASK_ADD;
constexpr std::uint32_t of_names =
    IN_CLOSE_WRITE | IN_ATTRIB | IN_CREATE | IN_DELETE | IN_MOVED_FROM | IN_MOVED_TO;

/// The kernel's own words for its limits speak of disks and files.
std::string reason(int error) {
    if (error == ENOSPC) return "the limit fs.inotify.max_user_watches is reached";
    if (error == EMFILE) return "the limit fs.inotify.max_user_instances, or that of open files, is reached";
    return std::strerror(error);
}

/// Else a path is wrong, which who reads it will say.
bool is_limit(int error) {
    return error == ENOSPC || error == ENOMEM || error == EMFILE;
}

/// A file that was opened, and has not been written yet. The end of that is an event of its own.
bool is_begun(const fs::path& path) {
    struct stat info = {};
    return ::lstat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode) && info.st_size == 0;
}

} // namespace

FileWatch::FileWatch()
    : events_(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)), news_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      end_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (events_ < 0 || news_ < 0 || end_ < 0) {
        status_ = Status::failure("cannot watch files: " + reason(errno));
        return;
    }
    try {
        thread_ = std::thread([this] { run(); });
    } catch (const std::system_error& error) {
        status_ = Status::failure("cannot watch files: " + error.code().message());
    }
}

FileWatch::~FileWatch() {
    if (thread_.joinable()) {
        ::eventfd_write(end_, 1);
        thread_.join();
    }
    for (const int descriptor : {events_, news_, end_})
        if (descriptor >= 0) ::close(descriptor);
}

Status FileWatch::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

/// The first failure stays.
void FileWatch::fail(const std::string& folder, int error) {
    if (status_.ok()) status_ = Status::failure(fmt::format("cannot watch '{}': {}", folder, reason(error)));
}

void FileWatch::add(const std::string& path) {
    const std::lock_guard lock(mutex_);
    if (status_.ok() && files_.insert(path).second) follow(path, path, most_links);
}

std::vector<std::string> FileWatch::take() {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> files(changed_files_.begin(), changed_files_.end());
    changed_files_.clear();
    eventfd_t count = 0;
    ::eventfd_read(news_, &count);
    changed_ = false;
    return files;
}

/// False where the folder cannot be watched.
bool FileWatch::watch(const fs::path& folder, const std::string& name, const std::string& file) {
    const int number =
        ::inotify_add_watch(events_, folder.c_str(), name.empty() ? of_folder : of_folder | of_names);
    if (number < 0) return false;
    Folder& watched = folders_[number];
    watched.path = folder;
    watched.files[name].insert(file);
    return true;
}

/// Watches all that decides what the path leads to: the last folder for the name, folders with links for the
/// links, and every folder for being moved. Where one is not there, the folder before it is watched for it.
void FileWatch::follow(const fs::path& path, const std::string& file, int most_links) {
    std::error_code error;
    const fs::path whole = fs::absolute(path, error);
    fs::path at;
    for (auto part = whole.begin(); part != whole.end(); ++part) {
        at /= *part;
        const bool last = std::next(part) == whole.end();
        fs::file_type type = fs::symlink_status(at, error).type();
        if (type == fs::file_type::directory && !last) {
            if (watch(at, "", file)) continue;
            if (is_limit(errno)) return fail(at.string(), errno);
            if (errno == EACCES) continue; // who may not read a folder can still use what is in it
        }
        if (!watch(at.parent_path(), at.filename().string(), file) &&
            (is_limit(errno) || (errno == EACCES && type != fs::file_type::none)))
            return fail(at.parent_path().string(), errno);
        type = fs::symlink_status(at, error).type(); // the file may have come meanwhile
        if (type == fs::file_type::symlink && most_links > 0) {
            const fs::path target = fs::read_symlink(at, error);
            if (!error) follow(at.parent_path() / target, file, most_links - 1);
        }
        if (last || type == fs::file_type::not_found || type == fs::file_type::none) return;
    }
}

void FileWatch::run() {
    std::array<pollfd, 2> wanted = {{{events_, POLLIN, 0}, {end_, POLLIN, 0}}};
    for (;;) {
        const int ready = ::poll(wanted.data(), wanted.size(), -1);
        if (ready < 0 && errno == EINTR) continue;
        const std::lock_guard lock(mutex_);
        if (ready < 0) {
            status_ =
                Status::failure(fmt::format("cannot wait for changes of files: {}", std::strerror(errno)));
            return tell();
        }
        if (wanted[1].revents != 0) return;
        read_events();
        if (!changed_files_.empty()) tell();
    }
}

void FileWatch::tell() {
    if (!changed_.exchange(true)) ::eventfd_write(news_, 1);
}

void FileWatch::read_events() {
    alignas(inotify_event) std::array<char, 1 << 14> bytes;
    const ssize_t count = ::read(events_, bytes.data(), bytes.size());
    for (ssize_t at = 0; at < count;) {
        inotify_event event = {};
        std::memcpy(&event, bytes.data() + at, sizeof event);
        const char* const name = bytes.data() + at + sizeof event;
        note(event.wd, event.mask, event.len > 0 ? std::string(name) : std::string());
        at += static_cast<ssize_t>(sizeof event + event.len);
    }
}

void FileWatch::note(int folder, std::uint32_t what, const std::string& name) {
    std::set<std::string> files;
    if (what & IN_Q_OVERFLOW) files = files_; // events were lost
    if (const auto known = folders_.find(folder); known != folders_.end()) {
        const Folder& watched = known->second;
        const bool opened = (what & IN_CREATE) && is_begun(watched.path / name);
        if (name.empty()) {
            for (const auto& [unused, dependent] : watched.files)
                files.insert(dependent.begin(), dependent.end());
        } else if (const auto of_name = watched.files.find(name); of_name != watched.files.end() && !opened) {
            files = of_name->second;
        }
        if (what & IN_IGNORED) folders_.erase(known);
    }
    // Their paths may lead elsewhere now.
    for (const std::string& file : files)
        follow(file, file, most_links);
    changed_files_.merge(files);
}

} // namespace graftal
