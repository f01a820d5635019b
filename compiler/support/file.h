#pragma once

#include <string>
#include <string_view>

#include "compiler/support/status.h"

namespace graftal {

/// True for what is there and is no regular file. To be asked before a file is opened: opening a pipe that
/// nobody writes would wait for ever.
bool is_special_file(const std::string& path);

/// Reads a regular file, or standard input for "-". Refuses more than `max_bytes`, so that a model cannot
/// be a device or a disk image.
Status read_text(const std::string& path, std::string& text, std::size_t max_bytes = 256u << 20);

/// An output that appears whole or not at all: bytes go to a temporary beside `path`, which commit()
/// renames. Without commit() the temporary is removed.
class PendingFile {
  public:
    explicit PendingFile(std::string path);
    ~PendingFile();
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    /// Where to write; ends with the extension of the final path, so that writers recognise the format.
    const std::string& temporary_path() const { return temporary_; }
    Status commit();

  private:
    std::string path_;
    std::string temporary_;
    bool committed_ = false;
};

/// Writes `text` to `path` by a PendingFile, or to standard output for "-".
Status write_text(const std::string& path, std::string_view text);

} // namespace graftal
