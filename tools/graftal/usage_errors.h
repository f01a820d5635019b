#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace graftal {

/// What is wrong with the first word, which most likely is a misspelt command, or "".
std::string wrong_command(int argc, const char* const* argv, const std::vector<std::string>& commands);

/// "there is no command 'rendr' (did you mean 'render'?)"
std::string unknown_command(const std::string& word, const std::vector<std::string>& commands);

/// What CLI11 found wrong with the words after a command, in our own: which option there is not, which word
/// is one too many, which value is missing. `command`: the one that was chosen, after it has parsed.
std::string usage_message(const CLI::ParseError& error, const CLI::App& command);

} // namespace graftal
