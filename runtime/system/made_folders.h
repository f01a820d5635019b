#pragma once

#include <string>
#include <vector>

#include "compiler/support/status.h"

namespace graftal {

/// Folders that a command makes for its output, and takes back where nothing came of it.
class MadeFolders {
  public:
    /// Makes the folder, and those above it, where they are missing.
    Status make(const std::string& path);
    /// Removes those of them that are empty. What was there before stays.
    void take_back();

  private:
    std::vector<std::string> made_; ///< the outermost first
};

} // namespace graftal
