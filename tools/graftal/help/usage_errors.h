#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace graftal {

/// The problem with the first word, which most likely is a misspelt command, or "".
std::string wrong_command(int argc, const char* const* argv, const std::vector<std::string>& commands);

/// "there is no command 'rendr' (did you mean 'render'?)"
std::string unknown_command(const std::string& word, const std::vector<std::string>& commands);

/// "--quality: 'nromal' is not draft, normal or best (did you mean 'normal'?)"
std::string unknown_word(const std::string& option, const std::string& word,
                         const std::vector<std::string>& words);

/// CLI11's complaint about words after a command, in our own words: an unknown option, a word too many, a
/// missing value. `command`: the one that was chosen, after it has parsed.
std::string usage_message(const CLI::ParseError& error, const CLI::App& command);

} // namespace graftal
