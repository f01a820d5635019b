#pragma once

#include <string>
#include <vector>

#include "runtime/studio/studio_state.h"

namespace graftal {

/// The words of a command line that does this with the state's model: "render" or "export". Its text is to be
/// saved under its name.
std::vector<std::string> command_words(const StudioState& state, const std::string& command);

/// The command line that draws the state's picture, once its text is saved under its name; for a shell.
std::string command_line(const StudioState& state);

} // namespace graftal
