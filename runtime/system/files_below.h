#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fcntl.h>

#include "compiler/support/status.h"

namespace graftal {

// Files of a folder that a stranger may have made. The path of the folder itself is the user's, and may lead
// over symbolic links. Below it graftal follows no link, and opens no pipe and no device.

/// Whether a name can only lie below a folder: relative, in UTF-8 without control characters, and no part of
/// it is "", "." or "..".
bool is_name_below(std::string_view name);

/// Opens the regular file of this name: its descriptor, which the caller closes; else -1 and errno. `flags`
/// are those of open(); a file that O_CREAT makes is its owner's alone.
int open_below(const std::string& folder, std::string_view name, int flags = O_RDONLY);

/// The size of the file of this name; nothing where open_below() fails.
std::optional<std::uint64_t> bytes_below(const std::string& folder, std::string_view name);

/// Reads it; refuses a longer file before it reads a byte.
Status read_below(const std::string& folder, std::string_view name, std::string& text,
                  std::uint64_t most_bytes);

/// Fails where open_below() could not open the file, there or not. For callers that open a path by other
/// means, and right now.
Status check_below(const std::string& folder, std::string_view name);

} // namespace graftal
