#include "runtime/system/file.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "runtime/system/signal_registry.h"

namespace graftal {

namespace {

Status read_stream(std::FILE* stream, const std::string& path, std::string& text, std::size_t max_bytes) {
    text.clear();
    char buffer[1 << 16];
    while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, stream)) {
        if (text.size() + count > max_bytes)
            return Status::failure(fmt::format("'{}' is too long: more than {} bytes", path, max_bytes));
        text.append(buffer, count);
    }
    return std::ferror(stream) ? system_failure("read", path) : Status();
}

/// The temporaries, for handlers of signals. One that finds no place is left to the next run.
SignalRegistry<char, 1024> pending_paths;

/// The times of a temporary that its writer has not opened yet: access, change.
constexpr timespec never_written[2] = {{1, 0}, {1, 0}};

/// Whether a name is that of a temporary of PendingFile: `.STEM.PROCESS.COUNTER.EXTENSION`.
bool is_temporary_of(const std::filesystem::path& target, const std::string& after, std::string_view name) {
    const std::string before = fmt::format(".{}.", target.stem().string());
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
        return false;
    const std::string_view numbers = name.substr(before.size(), name.size() - before.size() - after.size());
    return std::count(numbers.begin(), numbers.end(), '.') == 1 && numbers.front() != '.' &&
           numbers.back() != '.' && numbers.find_first_not_of("0123456789.") == std::string_view::npos;
}

/// Removes what runs that were killed have left of an output. A run has few outputs, except for the frames of
/// a film, whose folder is tidied in one go.
void remove_abandoned(const std::filesystem::path& target, const std::string& extension) {
    constexpr unsigned enough = 100;
    static std::atomic<unsigned> count = 0;
    if (++count > enough) return;
    const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!is_temporary_of(target, extension, name)) continue;
        const int lock = lock_path(entry->path().string());
        if (lock < 0) continue; // its writer is at work
        ::unlink(entry->path().c_str());
        ::close(lock);
    }
}

} // namespace

Status system_failure(std::string_view verb, std::string_view path, int reason) {
    return Status::failure(fmt::format("cannot {} '{}': {}", verb, path, std::strerror(reason)));
}

bool is_special_file(const std::string& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

std::string special_file_text(const std::string& path) {
    std::error_code error;
    return std::filesystem::is_directory(path, error) ? "a folder, not a file: name a file in it"
                                                      : "not a regular file";
}

bool lies_in(const std::string& path, const std::string& folder) {
    std::error_code error, folder_error;
    // A path need not exist to its end, but a link without a target leads nowhere, and is refused.
    // A relative one of which nothing exists would stay relative.
    const std::filesystem::path whole = std::filesystem::absolute(path, error);
    const std::filesystem::path inner =
        error ? std::filesystem::path() : std::filesystem::weakly_canonical(whole, error);
    const std::filesystem::path outer = std::filesystem::canonical(folder, folder_error);
    if (error || folder_error || std::filesystem::is_symlink(inner, error)) return false;
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

Status read_text(const std::string& path, std::string& text, std::size_t max_bytes) {
    if (path == "-") return read_stream(stdin, "standard input", text, max_bytes);
    if (is_special_file(path))
        return Status::failure(fmt::format("cannot read '{}': it is {}", path, special_file_text(path)));
    const OpenFile file(std::fopen(path.c_str(), "rb"));
    if (!file) return system_failure("open", path);
    return read_stream(file.get(), path, text, max_bytes);
}

Status output_target(const std::string& path, std::string& target) {
    constexpr int most_links = 40; // as the kernel has it
    std::filesystem::path at = path;
    std::error_code error;
    for (int i = 0; std::filesystem::is_symlink(at, error); ++i) {
        if (i == most_links) return system_failure("write", path, ELOOP);
        at = at.parent_path() / std::filesystem::read_symlink(at, error);
    }
    target = at.string();
    if (!is_special_file(target) || std::filesystem::is_directory(target, error)) return {};
    return Status::failure(
        fmt::format("cannot write '{}': it is not a regular file (the name '-' is standard "
                    "output, where graftal can write to that)",
                    path));
}

int lock_path(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
    if (file >= 0) ::close(file);
    return -1;
}

PendingFile::PendingFile(std::string path) : path_(std::move(path)), status_(output_target(path_, target_)) {
    if (!status_.ok()) return;
    remove_abandoned(target_, std::filesystem::path(path_).extension().string());
    create();
}

/// A name beside the target for another file of this process.
std::string PendingFile::temporary_name() const {
    static std::atomic<unsigned> count = 0; // two writers of one file do not share a temporary
    const std::filesystem::path target(target_);
    const std::string name = fmt::format(".{}.{}.{}{}", target.stem().string(), ::getpid(), ++count,
                                         std::filesystem::path(path_).extension().string());
    return (target.parent_path() / name).string();
}

/// Makes the temporary. If it cannot be made, writers to it report that.
void PendingFile::create() {
    for (int tries = 0; tries < 3; ++tries) {
        temporary_ = temporary_name();
        lock_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        // Another may have taken it for abandoned before it was locked.
        if (lock_ < 0) break;
        ::futimens(lock_, never_written);
        struct stat info = {};
        if (::flock(lock_, LOCK_EX) != 0 || ::fstat(lock_, &info) != 0 || info.st_nlink > 0) break;
        ::close(std::exchange(lock_, -1));
    }
    pending_paths.note(temporary_.c_str());
}

Status PendingFile::check_written() const {
    if (!status_.ok()) return status_;
    struct stat info = {};
    const bool there = ::stat(temporary_.c_str(), &info) == 0;
    if (!there && errno != ENOENT) return system_failure("write", path_);
    if (there && (info.st_size > 0 || info.st_mtim.tv_sec != never_written[1].tv_sec)) return {};
    return Status::failure(fmt::format("cannot write '{}': no data came", path_));
}

PendingFile::~PendingFile() {
    if (!temporary_.empty()) {
        pending_paths.forget(temporary_.c_str());
        if (!committed_ || exchanged_) ::unlink(temporary_.c_str());
    }
    if (!before_.empty()) {
        pending_paths.forget(before_.c_str());
        ::unlink(before_.c_str());
    }
    if (lock_ >= 0) ::close(lock_);
}

Status PendingFile::commit() {
    if (Status status = check_written(); !status.ok()) return status;
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) return system_failure("write", path_);
    committed_ = true;
    return {};
}

/// Commits, but keeps the old file: under the temporary's name, or where the file system cannot exchange two
/// names, under another. On one without hard links it is gone.
Status PendingFile::take_place() {
    if (Status status = check_written(); !status.ok()) return status;
    exchanged_ = !is_special_file(target_) &&
                 ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0;
    if (!exchanged_) {
        was_there_ = ::access(target_.c_str(), F_OK) == 0;
        std::string before = temporary_name();
        if (was_there_ && ::link(target_.c_str(), before.c_str()) == 0) {
            before_ = std::move(before);
            pending_paths.note(before_.c_str());
        }
        return commit();
    }
    committed_ = true;
    return {};
}

void PendingFile::give_back() {
    if (exchanged_)
        ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE);
    else if (!was_there_)
        ::unlink(target_.c_str());
    else if (!before_.empty())
        ::rename(before_.c_str(), target_.c_str());
}

Status commit_together(std::span<PendingFile* const> files) {
    for (std::size_t i = 0; i < files.size(); ++i) {
        Status status = files[i]->take_place();
        if (status.ok()) continue;
        while (i > 0)
            files[--i]->give_back();
        return status;
    }
    return {};
}

void remove_pending_files() noexcept {
    pending_paths.for_each([](const char* path) { ::unlink(path); });
}

Status write_text(const std::string& path, std::string_view text) {
    if (path == "-") {
        const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
        if (written && std::fflush(stdout) == 0) return {};
        if (errno == EPIPE) return {}; // as in `graftal print M | head`: the reader has what it wants
        return system_failure("write", "standard output");
    }
    PendingFile pending(path);
    if (!pending.status().ok()) return pending.status();
    const Status status = write_text(pending, text);
    return status.ok() ? pending.commit() : status;
}

FileStamp stamp_of(const std::string& path) {
    std::error_code error;
    const auto time = std::filesystem::last_write_time(path, error);
    if (error) return {};
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    return error ? FileStamp() : FileStamp{time.time_since_epoch().count(), bytes};
}

Status write_text(const PendingFile& pending, std::string_view text) {
    OpenFile file(std::fopen(pending.temporary_path().c_str(), "wb"));
    if (!file) return system_failure("write", pending.path());
    const bool written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
    return written && std::fclose(file.release()) == 0 ? Status() : system_failure("write", pending.path());
}

} // namespace graftal
