#pragma once

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

namespace graftal {

/// Whether only our tests use the option: help, manual and completions do not show it.
bool is_for_tests(const CLI::Option& option);

/// Puts the options of a command under headings, such as "Camera", if there are too many for one list.
void group_options(CLI::App& command);

/// The text after the options of a help. Its examples begin with "Example:" or "Examples:", and end it.
struct HelpFooter {
    std::string notes;
    std::string examples;
};
HelpFooter help_footer(const CLI::App& command);

/// Help that shows the examples first, then the options under their headings, then the notes.
std::shared_ptr<CLI::Formatter> help_formatter();

} // namespace graftal
