#include "tools/graftal/manual.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace graftal {

namespace {

/// Text in which troff finds nothing of its own. Hyphens stay those of the command line, so that they can be
/// copied.
std::string text(const std::string& plain) {
    std::string escaped;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const bool begins_line = i == 0 || plain[i - 1] == '\n';
        if (begins_line && (plain[i] == '.' || plain[i] == '\'')) escaped += "\\&";
        if (plain[i] == '\\')
            escaped += "\\e";
        else if (plain[i] == '-')
            escaped += "\\-";
        else if (plain[i] == '\'')
            escaped += "\\(aq";
        else if (plain[i] == '^')
            escaped += "\\(ha";
        else if (plain[i] == '`')
            escaped += "\\(ga";
        else if (plain[i] == '~')
            escaped += "\\(ti";
        else
            escaped += plain[i];
    }
    return escaped;
}

std::string bold(const std::string& word) {
    return "\\fB" + text(word) + "\\fR";
}

std::string italic(const std::string& word) {
    return "\\fI" + text(word) + "\\fR";
}

std::string section(const std::string& heading, const std::string& body) {
    return body.empty() ? "" : ".SH " + heading + "\n" + body;
}

std::string synopsis(const CommandTree& command) {
    std::string line = bold(command.name(" "));
    if (!command.commands.empty()) return line + " " + italic("COMMAND") + " [" + italic("OPTION") + "]...\n";
    line += " [" + italic("OPTION") + "]...";
    for (const OptionEntry& operand : command.operands)
        line += " " + italic(operand.value) +
                (operand.repeats && operand.value.find(' ') == std::string::npos ? "..." : "");
    return line + "\n";
}

std::string options(const CommandTree& command) {
    std::string body;
    for (const OptionEntry& operand : command.operands)
        body += fmt::format(".TP\n{}\n{}.\n", italic(operand.value), text(operand.help));
    for (const OptionEntry& option : command.options) {
        std::vector<std::string> names;
        for (const std::string& name : option.names)
            names.push_back(bold(name) + (option.value.empty() ? "" : " " + italic(option.value)));
        body += fmt::format(".TP\n{}\n{}.\n", fmt::join(names, ", "), text(option.help));
    }
    return body;
}

std::string commands_of(const CommandTree& command) {
    std::string body;
    for (const CommandTree& below : command.commands)
        body += fmt::format(".TP\n{}(1)\n{}.\n", bold(below.name("-")), text(below.summary));
    return body;
}

std::string examples(const CommandTree& command) {
    return command.examples.empty() ? "" : ".EX\n" + text(command.examples) + ".EE\n";
}

/// The other pages, without those of commands below commands.
std::string see_also(const CommandTree& command, const CommandTree& whole) {
    std::vector<std::string> pages;
    if (&command != &whole) pages.push_back(bold(whole.path.front()) + "(1)");
    for (const CommandTree& other : whole.commands)
        if (&other != &command) pages.push_back(bold(other.name("-")) + "(1)");
    pages.push_back(bold("povray") + "(1)");
    return fmt::format("{}\n", fmt::join(pages, ",\n"));
}

constexpr const char* exit_status = ".TP\n0\nSuccess.\n"
                                    ".TP\n1\nThe model or the result is at fault.\n"
                                    ".TP\n2\nThe command line is wrong.\n"
                                    ".TP\n3\nThe environment is at fault: files, memory, POV\\-Ray.\n"
                                    ".TP\n128 + \\fIn\\fR\nSignal \\fIn\\fR ended the command.\n";

} // namespace

std::string manual_page(const CommandTree& command, const CommandTree& whole) {
    const bool is_whole = &command == &whole;
    std::string summary = command.summary;
    for (char& c : summary)
        if (c == '\n') c = ' ';
    std::string page =
        fmt::format(".TH {} 1 \"\" \"graftal {}\" \"graftal\"\n", text(command.name("-")), GRAFTAL_VERSION);
    page +=
        section("NAME", fmt::format("{} \\- {}\n", text(command.name("-")),
                                    is_whole ? "pictures of fractals and plants, from models of a few lines"
                                             : text(summary)));
    page += section("SYNOPSIS", synopsis(command));
    page += section("DESCRIPTION", text(summary) + (summary.ends_with('.') ? "" : ".") + "\n" +
                                       (command.notes.empty() ? "" : ".PP\n" + text(command.notes)));
    page += section("COMMANDS", commands_of(command));
    page += section("OPTIONS", options(command));
    page += section("EXIT STATUS", exit_status);
    page += section("EXAMPLES", examples(command));
    page += section("SEE ALSO", see_also(command, whole));
    return page;
}

} // namespace graftal
