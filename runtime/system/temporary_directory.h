#pragma once

#include <cstdio>
#include <string>

#include "compiler/support/status.h"

namespace graftal {

/// A fresh directory under TMPDIR (or /tmp), removed with all that is in it at the end. It is locked (flock)
/// while this lives: those that killed runs have left are not, and create() removes them.
class TemporaryDirectory {
  public:
    TemporaryDirectory() = default;
    ~TemporaryDirectory();
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

    Status create();
    const std::string& path() const { return path_; }

  private:
    friend void remove_temporary_directories() noexcept;
    void remove() const noexcept;

    std::string outer_, path_;
    // Held, so that all can be removed where no more files can be opened.
    int lock_ = -1, folder_ = -1;
};

/// Removes all of them that there are. For handlers of signals: only system calls.
void remove_temporary_directories() noexcept;

/// A file there that has no name and goes when it is closed; null with errno.
std::FILE* open_temporary_file();

} // namespace graftal
