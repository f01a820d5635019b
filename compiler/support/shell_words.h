#pragma once

#include <string>
#include <vector>

namespace graftal {

/// The words as a POSIX shell would have to be given them.
std::string shell_quoted(const std::vector<std::string>& words);

} // namespace graftal
