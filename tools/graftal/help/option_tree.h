#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace graftal {

/// Words that a shell offers for a value.
enum class ValueKind { text, model, picture, file, folder };

/// An option of a command, or an operand.
struct OptionEntry {
    std::vector<std::string> names; ///< "-o", "--output"; none of an operand
    std::string value;              ///< stands for its value: "FILE", "WxH"; "" of a flag
    std::string help;
    std::string group; ///< the heading that it stands under, such as "Camera"
    ValueKind kind = ValueKind::text;
    std::vector<std::string> words; ///< to offer as its value; it may take others
    bool repeats = false;           ///< true if given more than once, or with several values
};

/// A command and those below it, as pages of the manual and shells' completions need them.
struct CommandTree {
    std::vector<std::string> path; ///< "graftal", "render"
    std::string summary;
    std::string notes;    ///< text of its help after the options, without the examples
    std::string examples; ///< a line each, without indentation
    std::vector<OptionEntry> options, operands;
    std::vector<CommandTree> commands;

    std::string name(const char* separator) const; ///< "graftal render" with " "
};

CommandTree option_tree(const CLI::App& app);

/// The tree itself and all below it, parents first.
std::vector<const CommandTree*> all_commands(const CommandTree& tree);

/// The first clause of a help text: what a shell shows in one line.
std::string in_one_line(const std::string& help);

} // namespace graftal
