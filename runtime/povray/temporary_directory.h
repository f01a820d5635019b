#pragma once

#include <string>

#include "compiler/support/status.h"

namespace graftal {

/// A fresh directory under TMPDIR (or /tmp), removed with all that is in it at the end.
class TemporaryDirectory {
  public:
    TemporaryDirectory() = default;
    ~TemporaryDirectory();
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

    Status create();
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

} // namespace graftal
