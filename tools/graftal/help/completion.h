#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/graftal/help/option_tree.h"

namespace graftal {

/// "bash", "fish", "zsh".
std::vector<std::string> completed_shells();

/// The script by which the shell completes the words of a command line. Requires a shell of
/// completed_shells().
std::string completion_script(std::string_view shell, const CommandTree& tree);

} // namespace graftal
