#pragma once

#include <cerrno>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "compiler/support/files.h"
#include "compiler/support/status.h"

namespace graftal {

/// The failure "cannot VERB 'PATH'", for a reason of the system.
Status system_failure(std::string_view verb, std::string_view path, int reason = errno);

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
/// A file that closes itself.
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

/// True for what is there and is no regular file. To be asked before a file is opened: opening a pipe that
/// nobody writes would wait for ever.
bool is_special_file(const std::string& path);

/// The reason why nobody reads a special file: "not a regular file", or that it is a folder.
std::string special_file_text(const std::string& path);

/// Whether a path, there or not, leads into a folder, with all symbolic links resolved on both sides.
bool lies_in(const std::string& path, const std::string& folder);

/// Reads a regular file, or standard input for "-". Refuses more than `max_bytes`, so that a model cannot
/// be a device or a disk image.
Status read_text(const std::string& path, std::string& text, std::size_t max_bytes = 256u << 20);

/// Where what is written to `path` goes: to the file that symbolic links lead to, there or not, as with other
/// programs. Fails for a ring of links, and for what is there and is no regular file: a pipe or a device
/// cannot be replaced whole, and must not be replaced by a file.
Status output_target(const std::string& path, std::string& target);

/// An output that appears whole or not at all: bytes go to a temporary beside its target (output_target),
/// which commit() renames. Without commit() the temporary is removed. It is locked (flock) while this lives:
/// what runs that were killed have left of this output is not, and is removed first.
class PendingFile {
  public:
    explicit PendingFile(std::string path);
    ~PendingFile();
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    /// Whether there is anything to write to; else nothing must be written.
    const Status& status() const { return status_; }
    /// Where to write; ends with the extension of `path`, so that writers recognise the format.
    const std::string& temporary_path() const { return temporary_; }
    const std::string& path() const { return path_; }
    Status commit();
    friend Status commit_together(std::span<PendingFile* const> files);

  private:
    std::string temporary_name() const;
    void create();
    Status check_written() const;
    Status take_place();
    void give_back();

    std::string path_;
    std::string target_;
    std::string temporary_;
    Status status_;
    int lock_ = -1;
    bool committed_ = false;
    bool exchanged_ = false; ///< the temporary is what was there before
    bool was_there_ = false; ///< if not exchanged: there was something before
    std::string before_;     ///< and its second name, or ""
};

/// Commits all of them in this order, or none: where one cannot be, those before it become again what they
/// were, unless the file system knows neither exchange nor hard links.
Status commit_together(std::span<PendingFile* const> files);

/// Removes the temporaries of all PendingFiles that there are. For handlers of signals: only system calls.
void remove_pending_files() noexcept;

/// Takes a lock on the file or folder at `path`, which ends with this process: its descriptor, or -1 where
/// another has it, or nothing can be locked there.
int lock_path(const std::string& path);

/// The stamp of a file; zeros where there is none.
FileStamp stamp_of(const std::string& path);

/// Writes `text` to a PendingFile, and does not commit it.
Status write_text(const PendingFile& pending, std::string_view text);

/// Writes `text` to `path` by a PendingFile, or to standard output for "-".
Status write_text(const std::string& path, std::string_view text);

} // namespace graftal
