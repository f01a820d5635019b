#pragma once

#include <string>
#include <vector>

#include "runtime/studio/studio_state.h"

namespace graftal {

/// The words of a command line that does this with the state's model: "render", "animate" or "export". Its
/// text is to be saved under its name.
std::vector<std::string> command_words(const StudioState& state, const std::string& command);

/// A number of a film. Throws BadMessage.
double film_number(const nlohmann::json& value);

/// The words that make a film of it: the field `film` of an ask (docs/studio.md). Throws BadMessage.
std::vector<std::string> film_words(StudioState state, const nlohmann::json& film);

/// The command line of these words, once the text is saved under its name; for a shell.
std::string command_line(const std::vector<std::string>& words);

} // namespace graftal
